"""What `explain` and a summary say of loose cargo: grains, coarse ones, and bulk."""
