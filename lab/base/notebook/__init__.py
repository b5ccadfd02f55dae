"""What a notebook shows: pieces of pages, and one output that is written anew."""
