"""launch.utilities.normalize_to_list_of_substitutions_impl of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.normalization import (
        is_a_subclass as is_a_subclass,
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
    )
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType, Substitution as Substitution

    SomeSubstitutionsType = _SomeSubstitutionsType
else:
    _LATE_NAMES = {
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "is_a_subclass": "kit.ros.launch.normalization:is_a_subclass",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
