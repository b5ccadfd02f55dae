"""What this machine has, what follows for the lab, and what the lab keeps on it."""
