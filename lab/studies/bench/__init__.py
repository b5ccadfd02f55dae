"""The lab's engine beside other people's: one file for each peer code."""
