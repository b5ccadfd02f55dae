"""What all other packages of the lab use: errors, texts, files, caches, signals, progress."""
