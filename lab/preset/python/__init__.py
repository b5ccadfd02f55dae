"""Presets as Python has them: from tables and texts, with quantities as values, and their keys one by one."""
