"""The presets: what each section may contain, and how presets are found, read and checked."""
