"""The page of a picture: its colours, its boxes, and the texts in them."""
