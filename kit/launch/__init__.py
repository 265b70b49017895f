"""Floor 4: carrying out ROS 2 launch files: finding packages, running their programs, and what stands in for
Flatland's server, for RViz and for ROS 2's own small programs."""
