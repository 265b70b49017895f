from kit.msg.flatland_msgs import Collision, Collisions, DebugTopicList, Vector2

__all__ = ["Collision", "Collisions", "DebugTopicList", "Vector2"]
