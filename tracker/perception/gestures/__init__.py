"""What does a hand say? Its shape in one image, and what that and its movement mean over time."""
