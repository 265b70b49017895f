from kit.ros.node.service_introspection import ServiceIntrospectionState

__all__ = ["ServiceIntrospectionState"]
