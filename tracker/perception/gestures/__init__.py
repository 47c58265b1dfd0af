"""Which gesture does a hand show? By its shape in one image, and its movement over time."""
