"""launch.frontend.parse_substitution of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.frontend.substitution_parser import parse_substitutions as _parse_substitution
    from kit.ros.launch.substitutions import TextSubstitution as TextSubstitution
    from kit.ros.package_index import get_package_share_directory as get_package_share_directory
    from yaml import Token as Token

    parse_substitution = _parse_substitution
    ExtractSubstitution: Any
    Lark: Any
    NormalizedValueType: Any
    StrSomeValueType: Any
    Transformer: Any
    get_grammar_path: Any
    instantiate_substitution: Any
    parse_if_substitutions: Any
    replace_escaped_characters: Any
else:
    _LATE_NAMES = {
        "ExtractSubstitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Lark": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "NormalizedValueType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "StrSomeValueType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "TextSubstitution": "kit.ros.launch.substitutions:TextSubstitution",
        "Token": "yaml:Token",
        "Transformer": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_grammar_path": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_package_share_directory": "kit.ros.package_index:get_package_share_directory",
        "instantiate_substitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "parse_if_substitutions": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "parse_substitution": "kit.ros.launch.frontend.substitution_parser:parse_substitutions",
        "replace_escaped_characters": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
