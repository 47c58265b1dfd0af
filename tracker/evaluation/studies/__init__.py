"""Many trials: who runs them, what is kept of them, and what they say together."""
