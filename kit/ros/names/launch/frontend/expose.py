"""launch.frontend.expose of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.entity import Action as Action
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType, Substitution as Substitution

    SomeSubstitutionsType = _SomeSubstitutionsType
    Entity: Any
    Parser: Any
    action_parse_methods: Any
    expose_action: Any
    expose_substitution: Any
    instantiate_action: Any
    instantiate_substitution: Any
    substitution_parse_methods: Any
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "Entity": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Parser": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "action_parse_methods": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "expose_action": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "expose_substitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "instantiate_action": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "instantiate_substitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "substitution_parse_methods": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
