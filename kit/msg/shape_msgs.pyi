from array import array as _array
from typing import ClassVar as _ClassVar

import numpy as _np
from numpy.typing import NDArray as _NDArray

from kit.msg import geometry_msgs as geometry_msgs
from kit.msg.message import Action as _Action
from kit.msg.message import Message as _Message
from kit.msg.message import Service as _Service

class Mesh(_Message):
    triangles: list[MeshTriangle] = ...
    vertices: list[geometry_msgs.Point] = ...
class MeshTriangle(_Message):
    vertex_indices: _NDArray[_np.uint32] = ...
class Plane(_Message):
    coef: _NDArray[_np.float64] = ...
class SolidPrimitive(_Message):
    BOX: _ClassVar[int]
    SPHERE: _ClassVar[int]
    CYLINDER: _ClassVar[int]
    CONE: _ClassVar[int]
    PRISM: _ClassVar[int]
    BOX_X: _ClassVar[int]
    BOX_Y: _ClassVar[int]
    BOX_Z: _ClassVar[int]
    SPHERE_RADIUS: _ClassVar[int]
    CYLINDER_HEIGHT: _ClassVar[int]
    CYLINDER_RADIUS: _ClassVar[int]
    CONE_HEIGHT: _ClassVar[int]
    CONE_RADIUS: _ClassVar[int]
    PRISM_HEIGHT: _ClassVar[int]
    type: int = ...
    dimensions: _array[float] = ...
    polygon: geometry_msgs.Polygon = ...
