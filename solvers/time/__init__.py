"""The step: its length, the clock, the watch, and the schedules that run it."""
