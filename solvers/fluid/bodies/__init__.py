"""Bodies, plates and hulls in the water: their wall particles, what hides what, and how free ones are moved."""
