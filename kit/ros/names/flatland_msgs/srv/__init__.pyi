from kit.msg.flatland_msgs import ChangeRate as ChangeRate
from kit.msg.flatland_msgs import DeleteModel as DeleteModel
from kit.msg.flatland_msgs import MoveModel as MoveModel
from kit.msg.flatland_msgs import SpawnModel as SpawnModel
