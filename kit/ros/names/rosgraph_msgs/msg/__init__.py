from kit.msg.rosgraph_msgs import Clock

__all__ = ["Clock"]
