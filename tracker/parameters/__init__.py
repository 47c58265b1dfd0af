"""Parameter files as ROS 2 reads them, and parameters that are gone."""
