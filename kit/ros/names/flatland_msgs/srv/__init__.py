from kit.msg.flatland_msgs import ChangeRate, DeleteModel, MoveModel, SpawnModel

__all__ = ["ChangeRate", "DeleteModel", "MoveModel", "SpawnModel"]
