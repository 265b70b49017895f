"""The interfaces of the ROS 2 package action_tutorials_interfaces: each is built from its text in ``definitions`` at first use."""

from typing import Any

from kit.msg.interfaces import package_attribute


def __getattr__(name: str) -> Any:
    return package_attribute(__name__, "action_tutorials_interfaces", ("action",), name)
