from kit.msg.nav_msgs import Goals as Goals
from kit.msg.nav_msgs import GridCells as GridCells
from kit.msg.nav_msgs import MapMetaData as MapMetaData
from kit.msg.nav_msgs import OccupancyGrid as OccupancyGrid
from kit.msg.nav_msgs import Odometry as Odometry
from kit.msg.nav_msgs import Path as Path
from kit.msg.nav_msgs import Trajectory as Trajectory
from kit.msg.nav_msgs import TrajectoryPoint as TrajectoryPoint
