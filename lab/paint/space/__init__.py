"""Pictures of spheres in a tank in space, drawn by the processor alone: camera, spheres, walls, light and edges."""
