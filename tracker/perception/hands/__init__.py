"""Hands in a picture: palm search, landmarks, and following from image to image."""
