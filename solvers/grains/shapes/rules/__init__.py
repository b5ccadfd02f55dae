"""Rules of contact for outlines: which contacts two of them have, and how deep they overlap."""
