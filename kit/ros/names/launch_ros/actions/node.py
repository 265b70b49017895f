"""launch_ros.actions.node of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.graph.naming import (
        validate_namespace as validate_namespace,
        validate_node_name as validate_node_name,
    )
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action
    from kit.ros.launch.file_substitutions import ExecutableInPackage as ExecutableInPackage
    from kit.ros.launch.normalization import (
        ensure_argument_type as ensure_argument_type,
        make_namespace_absolute as make_namespace_absolute,
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
        perform as _perform_substitutions,
        prefix_namespace as prefix_namespace,
    )
    from kit.ros.launch.parameters import Parameter as Parameter, ParameterFile as ParameterFile
    from kit.ros.launch.processes import ExecuteProcess as ExecuteProcess, Node as Node
    from kit.ros.launch.substitutions import (
        LocalSubstitution as LocalSubstitution,
        SomeText as _SomeSubstitutionsType,
    )
    from launch_ros.utilities import plugin_support as plugin_support
    from launch_ros.utilities.evaluate_parameters import evaluate_parameters as evaluate_parameters
    from launch_ros.utilities.normalize_parameters import normalize_parameters as normalize_parameters
    from tempfile import NamedTemporaryFile as NamedTemporaryFile

    SomeSubstitutionsType = _SomeSubstitutionsType
    perform_substitutions = _perform_substitutions
    Entity: Any
    NodeActionExtension: Any
    Parser: Any
    SomeParameters: Any
    SomeRemapRules: Any
    add_node_name: Any
    expose_action: Any
    g_entry_points_impl: Any
    get_data_type_from_identifier: Any
    get_extensions: Any
    get_node_name_count: Any
    instantiate_extension: Any
    normalize_remap_rules: Any
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "Entity": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ExecutableInPackage": "kit.ros.launch.file_substitutions:ExecutableInPackage",
        "ExecuteProcess": "kit.ros.launch.processes:ExecuteProcess",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "LocalSubstitution": "kit.ros.launch.substitutions:LocalSubstitution",
        "NamedTemporaryFile": "tempfile:NamedTemporaryFile",
        "Node": "kit.ros.launch.processes:Node",
        "NodeActionExtension": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Parameter": "kit.ros.launch.parameters:Parameter",
        "ParameterFile": "kit.ros.launch.parameters:ParameterFile",
        "Parser": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeParameters": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeRemapRules": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "add_node_name": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ensure_argument_type": "kit.ros.launch.normalization:ensure_argument_type",
        "evaluate_parameters": "launch_ros.utilities.evaluate_parameters:evaluate_parameters",
        "expose_action": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "g_entry_points_impl": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_data_type_from_identifier": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_extensions": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_node_name_count": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "instantiate_extension": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "make_namespace_absolute": "kit.ros.launch.normalization:make_namespace_absolute",
        "normalize_parameters": "launch_ros.utilities.normalize_parameters:normalize_parameters",
        "normalize_remap_rules": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
        "perform_substitutions": "kit.ros.launch.normalization:perform",
        "plugin_support": "launch_ros.utilities.plugin_support",
        "prefix_namespace": "kit.ros.launch.normalization:prefix_namespace",
        "validate_namespace": "kit.ros.graph.naming:validate_namespace",
        "validate_node_name": "kit.ros.graph.naming:validate_node_name",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
