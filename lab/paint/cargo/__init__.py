"""How cargoes look."""
