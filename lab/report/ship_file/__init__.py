"""What `cargolab hull` tells of a ship file."""
