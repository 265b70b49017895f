"""ROS 2's std_srvs: see ``kit.msg.std_srvs``."""
