"""Tables and plots of how well raised hands are detected."""
