"""Time stepping: the step length, the clock, the state checks, and the schedules that run a step."""
