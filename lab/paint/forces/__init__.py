"""The forces between grains in pictures: found again from recorded places, as chains and as pressure."""
