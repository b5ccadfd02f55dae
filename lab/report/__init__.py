"""What a run found, for people: figures, the summary, the page; and what a run will cost."""
