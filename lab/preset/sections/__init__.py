"""The sections of a preset, each as it may be given and as it comes out in full."""
