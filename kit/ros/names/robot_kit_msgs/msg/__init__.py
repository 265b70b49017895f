from kit.msg.robot_kit_msgs import BodyState

__all__ = ["BodyState"]
