"""Models that compute partly in 8 bits."""
