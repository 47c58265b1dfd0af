"""Where people are by now: motion models."""
