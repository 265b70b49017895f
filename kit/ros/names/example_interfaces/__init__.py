"""ROS 2's example_interfaces: see ``kit.msg.example_interfaces``."""
