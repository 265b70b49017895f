from kit.msg.turtlesim import Color as Color
from kit.msg.turtlesim import Pose as Pose
