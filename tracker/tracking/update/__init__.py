"""What measurements make of a track: correction, outliers, offsets that last."""
