"""A ship's lines: tables of offsets, fair curves through them, and the hull that they describe."""
