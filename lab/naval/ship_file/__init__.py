"""The ship file: hull, openings, tanks, holds, weights and loading conditions of a ship in one TOML file.

Numbers without a unit are in m, m², t, t m, m³/t, m⁴ and kg/m³; a text may give another unit, as "9200 mm".
"""
