"""What every room of the lab stands on: errors, texts, files, caches, signals, progress."""
