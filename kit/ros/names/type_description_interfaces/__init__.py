"""ROS 2's type_description_interfaces: see ``kit.msg.type_description_interfaces``."""
