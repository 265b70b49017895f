from kit.msg.turtlebot3_msgs import SensorState as SensorState
from kit.msg.turtlebot3_msgs import VersionInfo as VersionInfo
