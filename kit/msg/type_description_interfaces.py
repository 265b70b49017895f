"""The interfaces of the ROS 2 package type_description_interfaces: each is built from its text in ``definitions`` at first use."""

from typing import Any

from kit.msg.interfaces import package_attribute


def __getattr__(name: str) -> Any:
    return package_attribute(__name__, "type_description_interfaces", ("msg", "srv"), name)
