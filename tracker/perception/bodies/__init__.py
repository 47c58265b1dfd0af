"""People in a picture: pose models, and whose hand is whose."""
