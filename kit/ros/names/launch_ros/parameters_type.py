"""launch_ros.parameters_type of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.normalization import TEXT_TYPES as _SomeSubstitutionsType_types_tuple
    from kit.ros.launch.parameters import ParameterFile as ParameterFile, ParameterValue as ParameterValue
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType, Substitution as Substitution

    SomeSubstitutionsType = _SomeSubstitutionsType
    SomeSubstitutionsType_types_tuple = _SomeSubstitutionsType_types_tuple
    EvaluatedParameterValue: Any
    EvaluatedParameters: Any
    ParameterDescription: Any
    ParameterName: Any
    ParameterValueDescription: Any
    Parameters: Any
    ParametersDict: Any
    SomeParameterFile: Any
    SomeParameterName: Any
    SomeParameterValue: Any
    SomeParameterValue_types_tuple: Any
    SomeParameters: Any
    SomeParametersDict: Any
else:
    _LATE_NAMES = {
        "EvaluatedParameterValue": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "EvaluatedParameters": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ParameterDescription": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ParameterFile": "kit.ros.launch.parameters:ParameterFile",
        "ParameterName": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ParameterValue": "kit.ros.launch.parameters:ParameterValue",
        "ParameterValueDescription": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Parameters": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ParametersDict": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeParameterFile": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeParameterName": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeParameterValue": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeParameterValue_types_tuple": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeParameters": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeParametersDict": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "SomeSubstitutionsType_types_tuple": "kit.ros.launch.normalization:TEXT_TYPES",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
