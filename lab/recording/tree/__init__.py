"""A recording as xarray has it: named axes, units, labels and coordinates; frames are read as they are asked for."""
