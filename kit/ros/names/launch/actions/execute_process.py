"""launch.actions.execute_process of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.actions import Shutdown as Shutdown
    from kit.ros.launch.processes import (
        Executable as Executable,
        ExecuteLocal as ExecuteLocal,
        ExecuteProcess as ExecuteProcess,
    )
    from kit.ros.launch.substitutions import (
        SomeText as _SomeSubstitutionsType,
        Substitution as Substitution,
        TextSubstitution as TextSubstitution,
    )

    SomeSubstitutionsType = _SomeSubstitutionsType
    Entity: Any
    Parser: Any
    expose_action: Any
else:
    _LATE_NAMES = {
        "Entity": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Executable": "kit.ros.launch.processes:Executable",
        "ExecuteLocal": "kit.ros.launch.processes:ExecuteLocal",
        "ExecuteProcess": "kit.ros.launch.processes:ExecuteProcess",
        "Parser": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Shutdown": "kit.ros.launch.actions:Shutdown",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "TextSubstitution": "kit.ros.launch.substitutions:TextSubstitution",
        "expose_action": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
