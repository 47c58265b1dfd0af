"""Which measurement belongs to which track: admission, gating, probabilities."""
