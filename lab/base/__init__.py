"""Shared by all other packages of the lab: errors, texts, files, caches, signals, progress."""
