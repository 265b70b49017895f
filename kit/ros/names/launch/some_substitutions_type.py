"""launch.some_substitutions_type of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.launch.substitutions import SomeText as SomeSubstitutionsType

__all__ = ["SomeSubstitutionsType"]

if TYPE_CHECKING:
    from kit.ros.launch.normalization import TEXT_TYPES as _SomeSubstitutionsType_types_tuple
    from kit.ros.launch.substitutions import Substitution as Substitution

    SomeSubstitutionsType_types_tuple = _SomeSubstitutionsType_types_tuple
else:
    _LATE_NAMES = {
        "SomeSubstitutionsType_types_tuple": "kit.ros.launch.normalization:TEXT_TYPES",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
