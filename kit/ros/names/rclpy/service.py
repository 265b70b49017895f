from kit.ros.node.service import Service
from kit.ros.node.service_introspection import ServiceIntrospectionState

__all__ = ["Service", "ServiceIntrospectionState"]
