"""What a replay leaves for people to read: its page, its summary, its table of tracks."""
