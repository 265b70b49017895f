from kit.msg.turtlebot3_msgs import Patrol as Patrol
