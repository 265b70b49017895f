"""launch_ros.actions.push_ros_namespace of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.graph.naming import validate_namespace as validate_namespace
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action
    from kit.ros.launch.normalization import (
        make_namespace_absolute as make_namespace_absolute,
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
        perform as _perform_substitutions,
        prefix_namespace as prefix_namespace,
    )
    from kit.ros.launch.processes import (
        PushRosNamespace as _PushROSNamespace,
        PushRosNamespace as PushRosNamespace,
    )
    from kit.ros.launch.substitutions import (
        SomeText as _SomeSubstitutionsType,
        Substitution as Substitution,
        SubstitutionFailure as SubstitutionFailure,
    )

    PushROSNamespace = _PushROSNamespace
    SomeSubstitutionsType = _SomeSubstitutionsType
    perform_substitutions = _perform_substitutions
    Entity: Any
    Parser: Any
    expose_action: Any
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "Entity": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "Parser": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "PushROSNamespace": "kit.ros.launch.processes:PushRosNamespace",
        "PushRosNamespace": "kit.ros.launch.processes:PushRosNamespace",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "SubstitutionFailure": "kit.ros.launch.substitutions:SubstitutionFailure",
        "expose_action": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "make_namespace_absolute": "kit.ros.launch.normalization:make_namespace_absolute",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
        "perform_substitutions": "kit.ros.launch.normalization:perform",
        "prefix_namespace": "kit.ros.launch.normalization:prefix_namespace",
        "validate_namespace": "kit.ros.graph.naming:validate_namespace",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
