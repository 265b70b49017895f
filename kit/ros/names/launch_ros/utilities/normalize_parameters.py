"""launch_ros.utilities.normalize_parameters of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.normalization import (
        TEXT_TYPES as _SomeSubstitutionsType_types_tuple,
        ensure_argument_type as ensure_argument_type,
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
    )
    from kit.ros.launch.parameters import ParameterFile as ParameterFile, ParameterValue as ParameterValue
    from kit.ros.launch.substitutions import (
        SomeText as _SomeSubstitutionsType,
        Substitution as Substitution,
        TextSubstitution as TextSubstitution,
    )

    SomeSubstitutionsType = _SomeSubstitutionsType
    SomeSubstitutionsType_types_tuple = _SomeSubstitutionsType_types_tuple
    ParameterDescription: Any
    ParameterValueDescription: Any
    Parameters: Any
    ParametersDict: Any
    SomeParameterValue: Any
    SomeParameters: Any
    SomeParametersDict: Any
    normalize_parameter_dict: Any
    normalize_parameters: Any
else:
    _LATE_NAMES = {
        "ParameterDescription": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ParameterFile": "kit.ros.launch.parameters:ParameterFile",
        "ParameterValue": "kit.ros.launch.parameters:ParameterValue",
        "ParameterValueDescription": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Parameters": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ParametersDict": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeParameterValue": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeParameters": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeParametersDict": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "SomeSubstitutionsType_types_tuple": "kit.ros.launch.normalization:TEXT_TYPES",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "TextSubstitution": "kit.ros.launch.substitutions:TextSubstitution",
        "ensure_argument_type": "kit.ros.launch.normalization:ensure_argument_type",
        "normalize_parameter_dict": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "normalize_parameters": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
