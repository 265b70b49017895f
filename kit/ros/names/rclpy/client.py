from kit.ros.node.client import Client
from kit.ros.node.service_introspection import ServiceIntrospectionState

__all__ = ["Client", "ServiceIntrospectionState"]
