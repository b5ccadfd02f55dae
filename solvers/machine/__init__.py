"""What the physics runs on: Taichi started once, fields in memory, units of work, marks of what numbers mean."""
