"""What the ROS node and the DDS node share; it imports neither ROS nor DDS."""
