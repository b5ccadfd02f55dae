"""Texts, tables and figures of `cargolab roll-damping`."""
