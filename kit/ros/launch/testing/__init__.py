"""launch_testing of ROS 2: how a launch file says what is to be tested, and what its tests ask about its processes."""
