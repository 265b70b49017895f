"""Numbers that are one value by YAML 1.1, by which PyYAML and ROS 2 read, and another one by YAML 1.2, or as people write them.

Each reader of YAML asks ``ambiguity`` where it would take an unquoted word for a number, and refuses what it names.
"""

from __future__ import annotations

import re
from typing import Any, Final

import yaml

_ZERO_FIRST: Final = re.compile(r"[-+]?0[0-9_]+")
_GROUPED: Final = re.compile(r"[-+]?(?:[1-9][0-9]*_[0-9_]*|[0-9][0-9_]*\.[0-9_]*_[0-9_]*)", re.ASCII)
_BINARY: Final = re.compile(r"[-+]?0b[01_]+")
_SEXAGESIMAL: Final = re.compile(
    r"[-+]?(?:[1-9][0-9_]*(?::[0-5]?[0-9])+|[0-9][0-9_]*(?::[0-5]?[0-9])+\.[0-9_]*)", re.ASCII
)


def ambiguity(text: str) -> str | None:
    """The readings of an unquoted word that YAML's versions take for different values, and what to write; None for others.

    >>> ambiguity("012")
    "012 can be read in two ways: it is 10 in base eight, as YAML 1.1 and ROS 2 read it. Write 12, or '012' for a text"
    >>> ambiguity("1:30")
    "1:30 can be read in two ways: YAML 1.1 reads the number 90. Write 90, or '1:30' for a text"
    >>> ambiguity("007"), ambiguity("0x1F"), ambiguity("1e3")
    (None, None, None)
    """
    if not (text.startswith(("0", "-0", "+0")) or "_" in text or ":" in text):  # nearly all
        return None
    sign = "-" if text.startswith("-") else ""
    digits = text.lstrip("+-").replace("_", "")
    if _ZERO_FIRST.fullmatch(text) and digits:
        octal = str(int(digits, 8)) if set(digits) <= set("01234567") else ""
        if octal == str(int(digits)) and "_" not in text:
            return None
        shown = f"{sign}{octal}" if octal else "no whole number"
        reading, plain = f"it is {shown} in base eight, as YAML 1.1 and ROS 2 read it", f"{int(digits)}"
    elif _GROUPED.fullmatch(text):
        reading, plain = f"YAML 1.1 reads the number {sign}{digits}", digits
    elif _BINARY.fullmatch(text) and digits[2:]:
        plain = f"{int(digits[2:], 2)}"
        reading = f"YAML 1.1 reads the number {sign}{plain}"
    elif _SEXAGESIMAL.fullmatch(text):
        plain = _in_base_60(digits)
        reading = f"YAML 1.1 reads the number {sign}{plain}"
    else:
        return None
    return f"{text} can be read in two ways: {reading}. Write {sign}{plain}, or '{text}' for a text"


def _in_base_60(digits: str) -> str:
    value = 0.0
    for part in digits.split(":"):
        value = 60 * value + float(part)
    return f"{value:.10g}"


class AmbiguousNumber(yaml.YAMLError):
    """The message is what ``ambiguity`` says."""


class UnambiguousLoader(yaml.SafeLoader):
    """PyYAML's loader, which raises AmbiguousNumber."""

    def _construct_number(self, node: yaml.ScalarNode) -> Any:
        if told := ambiguity(node.value):
            raise AmbiguousNumber(told)
        is_integer = node.tag.endswith(":int")
        return self.construct_yaml_int(node) if is_integer else self.construct_yaml_float(node)


for _tag in ("int", "float"):
    UnambiguousLoader.add_constructor(f"tag:yaml.org,2002:{_tag}", UnambiguousLoader._construct_number)
