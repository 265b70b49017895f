from kit.msg.turtlesim import Kill as Kill
from kit.msg.turtlesim import SetPen as SetPen
from kit.msg.turtlesim import Spawn as Spawn
from kit.msg.turtlesim import TeleportAbsolute as TeleportAbsolute
from kit.msg.turtlesim import TeleportRelative as TeleportRelative
