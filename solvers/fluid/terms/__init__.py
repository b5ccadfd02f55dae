"""Models of the fluid as terms of its passes over pairs: one file each; `term` says what a term is."""
