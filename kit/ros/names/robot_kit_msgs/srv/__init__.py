from kit.msg.robot_kit_msgs import GetState, Reset, Step

__all__ = ["GetState", "Reset", "Step"]
