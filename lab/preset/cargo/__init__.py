"""The cargo library: published numbers of cargoes in bulk with their sources, and how a preset is filled from them."""
