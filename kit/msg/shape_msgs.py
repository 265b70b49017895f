"""Solids, planes, meshes: the interfaces of ROS 2's package shape_msgs."""

from typing import Annotated, ClassVar

from kit.msg.fields import MaxItems, float64_4, float64_array, uint8, uint32_3, zero
from kit.msg.geometry_msgs import Point, Polygon
from kit.msg.message import Message


class MeshTriangle(Message):
    vertex_indices: uint32_3 = zero


class Mesh(Message):
    triangles: list[MeshTriangle] = zero
    vertices: list[Point] = zero


class Plane(Message):
    coef: float64_4 = zero


class SolidPrimitive(Message):
    BOX: ClassVar[uint8] = 1
    SPHERE: ClassVar[uint8] = 2
    CYLINDER: ClassVar[uint8] = 3
    CONE: ClassVar[uint8] = 4
    PRISM: ClassVar[uint8] = 5
    BOX_X: ClassVar[uint8] = 0
    BOX_Y: ClassVar[uint8] = 1
    BOX_Z: ClassVar[uint8] = 2
    SPHERE_RADIUS: ClassVar[uint8] = 0
    CYLINDER_HEIGHT: ClassVar[uint8] = 0
    CYLINDER_RADIUS: ClassVar[uint8] = 1
    CONE_HEIGHT: ClassVar[uint8] = 0
    CONE_RADIUS: ClassVar[uint8] = 1
    PRISM_HEIGHT: ClassVar[uint8] = 0

    type: uint8 = zero
    dimensions: Annotated[float64_array, MaxItems(3)] = zero
    polygon: Polygon = zero
