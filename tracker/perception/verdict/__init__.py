"""Is this hand calling? Raise rules, and the evidence of everything that was seen."""
