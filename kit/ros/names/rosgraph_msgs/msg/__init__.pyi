from kit.msg.rosgraph_msgs import Clock as Clock
