"""Single impacts of two spheres, or of a sphere and a plane, beside the contact laws integrated without the solver."""
