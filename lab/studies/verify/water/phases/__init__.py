"""Water and air: what a second phase must keep, waves between two fluids, drops and bubbles under tension."""
