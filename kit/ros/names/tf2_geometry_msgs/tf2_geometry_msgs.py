from tf2_geometry_msgs import *  # noqa: F403 - the module in which ROS 2 has what the package names
from tf2_geometry_msgs import __all__ as __all__
