"""Runs: settle the beds, simulate all worlds together, write checkpoints, and continue interrupted runs."""
