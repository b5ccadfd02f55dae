"""What holds the cargo: outline, walls and parts that move."""
