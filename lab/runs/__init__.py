"""Runs: beds are settled, worlds launched together, checkpoints kept, and what was cut short goes on."""
