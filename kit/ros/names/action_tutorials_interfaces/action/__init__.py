from typing import Any

from kit.msg.interfaces import package_attribute


def __getattr__(name: str) -> Any:
    return package_attribute(__name__, "action_tutorials_interfaces", ("action",), name)
