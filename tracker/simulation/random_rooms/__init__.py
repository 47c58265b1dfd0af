"""Rooms and guests drawn at random."""
