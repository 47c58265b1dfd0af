"""The command `raised-hand`: one file per command, and what they share."""
