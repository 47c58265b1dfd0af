"""One trial: what happens in a scenario, what sensors see of it, what the tracker makes of it."""
