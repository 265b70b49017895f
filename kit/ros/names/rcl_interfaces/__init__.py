"""ROS 2's rcl_interfaces: see ``kit.msg.rcl_interfaces``."""
