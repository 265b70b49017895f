from kit.msg.robot_kit_msgs import GetState as GetState
from kit.msg.robot_kit_msgs import Reset as Reset
from kit.msg.robot_kit_msgs import Step as Step
