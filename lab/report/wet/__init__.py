"""What is said of wet cargo."""
