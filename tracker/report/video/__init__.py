"""Pictures of single moments, and the videos and viewers that show them in a row."""
