"""ROS 2's action_tutorials_interfaces: see ``kit.msg.action_tutorials_interfaces``."""
