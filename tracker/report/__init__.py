"""Pictures, tables and the summary of a replayed recording, drawn while it streams."""
