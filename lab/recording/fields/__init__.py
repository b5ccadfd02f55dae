"""Fields on a grid, from grains, water and bulk at points."""
