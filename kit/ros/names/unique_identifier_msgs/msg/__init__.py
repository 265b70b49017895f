from kit.msg.unique_identifier_msgs import UUID

__all__ = ["UUID"]
