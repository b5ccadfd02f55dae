"""What a preset may say, section by section, and how presets are found and read."""
