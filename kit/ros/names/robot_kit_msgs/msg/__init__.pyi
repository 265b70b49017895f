from kit.msg.robot_kit_msgs import BodyState as BodyState
