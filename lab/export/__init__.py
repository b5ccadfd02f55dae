"""A recording in the formats of other programs, after the run and from the recording alone (docs/exporting.md).

`Stage` says what is where at each picture: particles, walls, parts, hull and waterline. A format is a file of this
folder with a function that writes a stage, and a line in `names.NAMES` and in `exporting.WRITERS`.
"""
