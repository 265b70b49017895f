from kit.msg.turtlesim import RotateAbsolute as RotateAbsolute
