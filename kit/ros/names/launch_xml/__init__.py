"""ROS 2's launch_xml, as this project offers it."""
