from kit.msg.shape_msgs import Mesh as Mesh
from kit.msg.shape_msgs import MeshTriangle as MeshTriangle
from kit.msg.shape_msgs import Plane as Plane
from kit.msg.shape_msgs import SolidPrimitive as SolidPrimitive
