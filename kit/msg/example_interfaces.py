"""The interfaces of the ROS 2 package example_interfaces: each is built from its text in ``definitions`` at first use."""

from typing import Any

from kit.msg.interfaces import package_attribute


def __getattr__(name: str) -> Any:
    return package_attribute(__name__, "example_interfaces", ("action", "msg", "srv"), name)
