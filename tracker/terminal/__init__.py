"""What every program of ours shares in a terminal: help, progress bars, one line at the end."""
