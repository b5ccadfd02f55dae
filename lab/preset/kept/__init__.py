"""The keys of presets, kept in a file for what must not wait for the solvers: refusals, and opening a recording.

The schema takes a second to load, since motions and contact laws, whose classes it takes keys from, are compiled code.
`keys.json` says the same of its keys. `cargolab schema --out presets/schema.json` writes it anew together with the
schema for editors, and tests compare both with the code.
"""
