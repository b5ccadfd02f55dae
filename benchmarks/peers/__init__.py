"""Other granular codes on beds of ours, where they are installed: timed, and their centres of mass followed."""
