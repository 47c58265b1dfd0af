"""What the nodes on ROS 2 need beside the shared part; it imports rclpy."""
