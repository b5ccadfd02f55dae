"""Tanks in space: the solids that an outline stands for, and their walls."""
