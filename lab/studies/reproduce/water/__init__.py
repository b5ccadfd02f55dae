"""Experiments with water held against what was measured: impacts in a rolled tank, a dam break, waves in moved tanks.

The numbers of the experiments stand in these files with their sources. Whole measured series are not shipped: they are
drawn where the environment variable CARGOLAB_DATA names the folder that has them.
"""
