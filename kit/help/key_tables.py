"""Tables of the keys of a YAML format: what its reader asks for, with what its documentation says of each key."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from itertools import groupby
from typing import Final

from kit.document.blocks import CellStyle, Column, Table
from kit.world.key_table import FormatKey, key_meanings

_COLUMNS: Final = tuple(Column(title, CellStyle.TEXT) for title in ("Key", "Type and default", "Meaning"))
_UNITS: Final = re.compile(r" \[([^\]]+)\]")


def key_tables(name: str, keys: Iterable[FormatKey], *documentation: str) -> Iterator[Table]:
    """One table for each mapping of the format, the mapping of the file itself first.

    ``documentation``: docstrings with tables of meanings. A unit in brackets at the end of a meaning moves to the type.
    """
    meanings = {key: text for each in documentation for key, text in key_meanings(each).items()}
    for mapping, found in groupby(sorted(keys, key=_mapping_of_key), _mapping_of_key):
        title = (
            f"In every entry of {mapping}" if mapping.endswith("[]") else f"In {mapping}" if mapping else ""
        )
        rows = tuple(_key_row(each, meanings) for each in found)
        yield Table(
            f"{name}-{mapping.replace('[]', '').replace('.', '-')}".rstrip("-"), title, _COLUMNS, rows
        )


def _mapping_of_key(key: FormatKey) -> str:
    return key.key.rpartition(".")[0]


def _key_row(key: FormatKey, meanings: Mapping[str, str]) -> tuple[str, str, str]:
    documented = meanings.get(key.key, "")
    meaning = documented.replace("``", "")
    units = _UNITS.findall(meaning)
    type_ = key.type
    if len(units) == 1:
        meaning = _UNITS.sub("", meaning)
        type_, comma, bounds = key.type.partition(",") if "[" not in key.type else (key.type, "", "")
        type_ = f"{type_} in {units[0]}{comma}{bounds}"
    if not documented.startswith("``"):
        meaning = meaning[:1].upper() + meaning[1:]
    condition = f" Only with {key.only_with}." if key.only_with else ""
    return key.key.rpartition(".")[2], f"{type_}; {_default_text(key.default)}", f"{meaning}.{condition}"


def _default_text(default: str | None) -> str:
    if default is None:
        return "required"
    return "may be left out" if default in ("none", '""', "{}", "[]") else f"by default {default}"
