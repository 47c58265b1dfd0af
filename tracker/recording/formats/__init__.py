"""File formats of recordings: MCAP, rosbag2 databases and ROS 1 bags, damaged ones as well."""
