"""How good are tracks against the truth? Distances, consistency, identities, raised hands."""
