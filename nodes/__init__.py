"""The only place where ROS or DDS is imported: thin shells around `tracker.Pipeline`."""
