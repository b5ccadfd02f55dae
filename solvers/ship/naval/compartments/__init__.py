"""Tanks and holds of a ship as prisms: what they hold at a level, and how a liquid in them lies when she heels."""
