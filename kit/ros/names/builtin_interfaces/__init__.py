"""ROS 2's builtin_interfaces: see ``kit.msg.builtin_interfaces``."""
