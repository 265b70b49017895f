"""launch.utilities.type_utils of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.normalization import (
        ensure_argument_type as ensure_argument_type,
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
        perform as _perform_substitutions,
    )
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType, Substitution as Substitution

    SomeSubstitutionsType = _SomeSubstitutionsType
    perform_substitutions = _perform_substitutions
    AllowedTypesTuple: Any
    AllowedTypesType: Any
    AllowedValueType: Any
    ListTypesTuple: Any
    ListTypesType: Any
    ListValueType: Any
    NormalizedScalarType: Any
    NormalizedSequenceType: Any
    NormalizedValueType: Any
    ScalarTypesTuple: Any
    ScalarTypesType: Any
    ScalarValueType: Any
    SequenceValueType: Any
    SomeScalarType: Any
    SomeSequenceType: Any
    SomeValueType: Any
    StrSomeScalarType: Any
    StrSomeSequenceType: Any
    StrSomeValueType: Any
    coerce_list: Any
    coerce_to_type: Any
    extract_type: Any
    get_typed_value: Any
    is_instance_of: Any
    is_instance_of_valid_type: Any
    is_normalized_substitution: Any
    is_substitution: Any
    is_typing_list: Any
    is_valid_scalar_type: Any
    normalize_typed_substitution: Any
    perform_typed_substitution: Any
else:
    _LATE_NAMES = {
        "AllowedTypesTuple": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "AllowedTypesType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "AllowedValueType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "ListTypesTuple": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ListTypesType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ListValueType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "NormalizedScalarType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "NormalizedSequenceType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "NormalizedValueType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ScalarTypesTuple": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ScalarTypesType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ScalarValueType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SequenceValueType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeScalarType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeSequenceType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "SomeValueType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "StrSomeScalarType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "StrSomeSequenceType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "StrSomeValueType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "coerce_list": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "coerce_to_type": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ensure_argument_type": "kit.ros.launch.normalization:ensure_argument_type",
        "extract_type": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_typed_value": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "is_instance_of": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "is_instance_of_valid_type": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "is_normalized_substitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "is_substitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "is_typing_list": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "is_valid_scalar_type": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
        "normalize_typed_substitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "perform_substitutions": "kit.ros.launch.normalization:perform",
        "perform_typed_substitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
