"""What is remembered of a recording while it streams, in little memory."""
