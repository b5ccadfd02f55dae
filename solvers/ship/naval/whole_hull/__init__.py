"""What is asked of a whole hull beyond one condition: the largest KG that passes, and her strength in still water."""
