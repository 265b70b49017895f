from kit.msg.turtlebot3_msgs import Dqn as Dqn
from kit.msg.turtlebot3_msgs import Goal as Goal
from kit.msg.turtlebot3_msgs import Sound as Sound
