"""Runs: settle beds, advance worlds together, keep checkpoints, and continue interrupted runs."""
