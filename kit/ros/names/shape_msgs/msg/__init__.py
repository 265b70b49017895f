from kit.msg.shape_msgs import Mesh, MeshTriangle, Plane, SolidPrimitive

__all__ = ["Mesh", "MeshTriangle", "Plane", "SolidPrimitive"]
