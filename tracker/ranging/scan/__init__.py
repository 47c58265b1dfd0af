"""What stands in a scan: beams, segments, people, furniture."""
