"""Checks values from JSON against the types that a dataclass declares for its fields."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from types import UnionType
from typing import Any, Final, Literal, Union, get_args, get_origin, get_type_hints

from kit.plain_text import quoted

MAX_WHOLE: Final = 2**63
"""JSON knows no limit, but a float does."""


def check_field_types(record: type, values: Mapping[str, Any]) -> None:
    """Raises ValueError unless every value, as JSON gives it, has the type that the dataclass declares for it; KeyError for a
    name that it does not declare, and TypeError for what is no mapping."""
    if not isinstance(values, Mapping):
        raise TypeError(f"{quoted(repr(values)[:60])} is no {record.__name__}")
    for name, value in values.items():
        if not _is_of_type(value, _field_types(record)[name]):
            raise ValueError(f"{name} cannot be {quoted(repr(value)[:60])}")


@cache
def _field_types(record: type) -> dict[str, Any]:
    return get_type_hints(record)


def _is_of_type(value: Any, declared: Any) -> bool:
    if type(declared) is type and declared is not float:  # first, for a list may hold a million of them
        return type(value) is declared
    origin, inner = get_origin(declared), get_args(declared)
    if origin in (Union, UnionType):
        return any(_is_of_type(value, each) for each in inner)
    if origin is Literal:
        return value in inner
    if origin in (dict, Mapping):
        return type(value) is dict and all(_is_of_type(each, inner[1]) for each in value.values())
    if origin in (list, tuple):
        return type(value) in (list, tuple) and all(_is_of_type(each, inner[0]) for each in value)
    if declared is float:
        return type(value) is float or (type(value) is int and abs(value) <= MAX_WHOLE)
    return type(value) is declared
