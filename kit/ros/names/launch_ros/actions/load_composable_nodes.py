"""launch_ros.actions.load_composable_nodes of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action
    from kit.ros.launch.normalization import (
        TEXT_TYPES as _SomeSubstitutionsType_types_tuple,
        ensure_argument_type as ensure_argument_type,
        is_a_subclass as is_a_subclass,
        make_namespace_absolute as make_namespace_absolute,
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
        perform as _perform_substitutions,
        prefix_namespace as prefix_namespace,
    )
    from kit.ros.launch.parameters import ParameterFile as ParameterFile
    from kit.ros.launch.processes import (
        ComposableNode as ComposableNode,
        ComposableNodeContainer as ComposableNodeContainer,
        LoadComposableNodes as LoadComposableNodes,
    )
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType
    from launch_ros.utilities.evaluate_parameters import evaluate_parameters as evaluate_parameters
    from launch_ros.utilities.to_parameters_list import to_parameters_list as to_parameters_list
    from pathlib import Path as Path

    SomeSubstitutionsType = _SomeSubstitutionsType
    SomeSubstitutionsType_types_tuple = _SomeSubstitutionsType_types_tuple
    perform_substitutions = _perform_substitutions
    Entity: Any
    Parser: Any
    add_node_name: Any
    expose_action: Any
    get_composable_node_load_request: Any
    get_node_name_count: Any
    get_ros_node: Any
    normalize_parameter_dict: Any
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "ComposableNode": "kit.ros.launch.processes:ComposableNode",
        "ComposableNodeContainer": "kit.ros.launch.processes:ComposableNodeContainer",
        "Entity": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "LoadComposableNodes": "kit.ros.launch.processes:LoadComposableNodes",
        "ParameterFile": "kit.ros.launch.parameters:ParameterFile",
        "Parser": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Path": "pathlib:Path",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "SomeSubstitutionsType_types_tuple": "kit.ros.launch.normalization:TEXT_TYPES",
        "add_node_name": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ensure_argument_type": "kit.ros.launch.normalization:ensure_argument_type",
        "evaluate_parameters": "launch_ros.utilities.evaluate_parameters:evaluate_parameters",
        "expose_action": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_composable_node_load_request": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_node_name_count": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_ros_node": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "is_a_subclass": "kit.ros.launch.normalization:is_a_subclass",
        "make_namespace_absolute": "kit.ros.launch.normalization:make_namespace_absolute",
        "normalize_parameter_dict": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
        "perform_substitutions": "kit.ros.launch.normalization:perform",
        "prefix_namespace": "kit.ros.launch.normalization:prefix_namespace",
        "to_parameters_list": "launch_ros.utilities.to_parameters_list:to_parameters_list",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
