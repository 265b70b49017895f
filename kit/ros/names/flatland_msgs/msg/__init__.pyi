from kit.msg.flatland_msgs import Collision as Collision
from kit.msg.flatland_msgs import Collisions as Collisions
from kit.msg.flatland_msgs import DebugTopicList as DebugTopicList
from kit.msg.flatland_msgs import Vector2 as Vector2
