"""What a recording gives a study: its frames, the tracker's input, annotated scans."""
