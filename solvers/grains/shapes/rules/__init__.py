"""Contact rules for outlines: which contacts two outlines have, and their overlaps."""
