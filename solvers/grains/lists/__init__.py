"""Which grains and walls may touch: candidates, and the lists of contacts that are filtered from them."""
