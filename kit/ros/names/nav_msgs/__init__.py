"""ROS 2's nav_msgs: see ``kit.msg.nav_msgs``."""
