"""Programs of turtlesim, as ordinary rclpy nodes."""
