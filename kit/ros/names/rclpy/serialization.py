from kit.ros.serialization import deserialize_message, serialize_message

__all__ = ["deserialize_message", "serialize_message"]
