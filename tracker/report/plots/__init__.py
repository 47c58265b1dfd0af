"""Plots of a recording: the room from above, and who did what when."""
