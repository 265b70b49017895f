"""launch_ros.parameter_descriptions of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name
from kit.ros.launch.parameters import Parameter, ParameterFile, ParameterValue

__all__ = ["Parameter", "ParameterFile", "ParameterValue"]

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.frontend.substitution_parser import parse_substitutions as _parse_substitution
    from kit.ros.launch.normalization import (
        TEXT_TYPES as _SomeSubstitutionsType_types_tuple,
        ensure_argument_type as ensure_argument_type,
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
        perform as _perform_substitutions,
    )
    from kit.ros.launch.substitutions import (
        SomeText as _SomeSubstitutionsType,
        Substitution as Substitution,
        SubstitutionFailure as SubstitutionFailure,
    )
    from pathlib import Path as Path
    from tempfile import NamedTemporaryFile as NamedTemporaryFile

    SomeSubstitutionsType = _SomeSubstitutionsType
    SomeSubstitutionsType_types_tuple = _SomeSubstitutionsType_types_tuple
    parse_substitution = _parse_substitution
    perform_substitutions = _perform_substitutions
    AllowedTypesType: Any
    EvaluatedParameterValue: Any
    FilePath: Any
    SomeValueType: Any
    normalize_typed_substitution: Any
    perform_typed_substitution: Any
else:
    _LATE_NAMES = {
        "AllowedTypesType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "EvaluatedParameterValue": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "FilePath": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "NamedTemporaryFile": "tempfile:NamedTemporaryFile",
        "Path": "pathlib:Path",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "SomeSubstitutionsType_types_tuple": "kit.ros.launch.normalization:TEXT_TYPES",
        "SomeValueType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "SubstitutionFailure": "kit.ros.launch.substitutions:SubstitutionFailure",
        "ensure_argument_type": "kit.ros.launch.normalization:ensure_argument_type",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
        "normalize_typed_substitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "parse_substitution": "kit.ros.launch.frontend.substitution_parser:parse_substitutions",
        "perform_substitutions": "kit.ros.launch.normalization:perform",
        "perform_typed_substitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
