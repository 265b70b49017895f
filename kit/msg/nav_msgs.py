"""Odometry, paths, occupancy grids: the interfaces of ROS 2's package nav_msgs."""

from kit.msg.builtin_interfaces import Time
from kit.msg.fields import float32, int8_array, string, uint32, zero
from kit.msg.geometry_msgs import Point, Pose, PoseStamped, PoseWithCovariance, TwistWithCovariance
from kit.msg.message import Message
from kit.msg.std_msgs import Header


class GridCells(Message):
    header: Header = zero
    cell_width: float32 = zero
    cell_height: float32 = zero
    cells: list[Point] = zero


class MapMetaData(Message):
    map_load_time: Time = zero
    resolution: float32 = zero
    width: uint32 = zero
    height: uint32 = zero
    origin: Pose = zero


class OccupancyGrid(Message):
    header: Header = zero
    info: MapMetaData = zero
    data: int8_array = zero


class Odometry(Message):
    header: Header = zero
    child_frame_id: string = zero
    pose: PoseWithCovariance = zero
    twist: TwistWithCovariance = zero


class Path(Message):
    header: Header = zero
    poses: list[PoseStamped] = zero
