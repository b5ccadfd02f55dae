"""The sections of a preset, each as a user may give it and as resolved."""
