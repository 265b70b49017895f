"""Writes the modules of ``kit/ros/names``, ROS 2's import names, from one table: ``python -m tests.ros.import_names``.

``import_names.csv`` says of each module which names it has and where each of them lives. A row is a ``module`` of ROS 2, a
``name`` in it, its ``source`` (``MODULE:NAME``, or ``MODULE`` where the name is a module) and its ``kind``:

- empty: imported with the module, and in its ``__all__``
- ``unlisted``: likewise, but not in ``__all__``: ``rclpy.lifecycle.Node`` is not to be taken for the one of ``rclpy.node``
- ``late``: imported when it is first used, so that it costs no program's start; not in ``__all__``
- ``absent``: a name of ROS 2 that the kit does not have; the ``source`` says what it would need, and whoever uses it is told

The name ``*`` stands for all names of the module ``source``. A package that offers no name of its own needs no row. The files
are what editors and type checkers read; a test compares them with the table.
"""

from __future__ import annotations

import csv
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from textwrap import indent
from typing import Final, NamedTuple

from kit.ros import NAMES_FOLDER
from kit.ros.late_names import ABSENT

TABLE: Final = Path(__file__).with_name("import_names.csv")
LINE_LENGTH: Final = 110
TYPE_VARIABLES: Final = "kit.ros.type_support"
"""The module of type variables, to which type checkers let nothing be assigned."""
KINDS: Final = ("", "unlisted", "late", "absent")


class ImportName(NamedTuple):
    """One row of the table."""

    module: str
    name: str
    source: str
    kind: str

    @property
    def home(self) -> str:
        """The module in which the name lives; where it is a module itself, that one's package, if it is in one."""
        module, _, attribute = self.source.partition(":")
        return module if attribute else module.rpartition(".")[0]

    @property
    def home_name(self) -> str:
        """The name in its home."""
        return self.source.replace(":", ".").rpartition(".")[2]


def read_table(file: Path = TABLE) -> dict[str, list[ImportName]]:
    """Reads the names of each module, sorted. Raises ValueError for a name that is there twice, or of no known kind."""
    with file.open(newline="", encoding="utf-8") as opened:
        rows = [ImportName(*row) for row in csv.reader(opened)][1:]
    modules: dict[str, list[ImportName]] = defaultdict(list)
    for row in sorted(rows):
        if row.kind not in KINDS or any(row.name == each.name for each in modules[row.module]):
            raise ValueError(
                f"{file.name}: {row.module}.{row.name} is there twice, or is of no kind of {KINDS}"
            )
        modules[row.module].append(row)
    return {
        module: list({row.name: row for row in _with_stars(names, modules)}.values())
        for module, names in modules.items()
    }


def _with_stars(names: Sequence[ImportName], modules: Mapping[str, list[ImportName]]) -> Iterator[ImportName]:
    for row in names:
        if row.name != "*":
            yield row
        else:
            yield from (
                each._replace(module=row.module) for each in _with_stars(modules[row.source], modules)
            )


def name_files(file: Path = TABLE) -> dict[str, str]:
    """Returns the text of every module of a table, by its path within ``kit/ros/names``."""
    table = read_table(file)
    packages = {module.rpartition(".")[0] for module in table} - {""}
    packages |= {module.partition(".")[0] for module in table}
    return {
        f"{module.replace('.', '/')}{'/__init__' if module in packages else ''}.py": _module_text(
            module, table.get(module, [])
        )
        for module in sorted({*table, *packages})
    }


def _module_text(module: str, names: Sequence[ImportName]) -> str:
    parts = [
        f'"""{module} of ROS 2, as this project offers it."""\n\n# Made by: python -m tests.ros.import_names\n'
    ]
    late = [row for row in names if row.kind in ("late", "absent")]
    now = [row for row in names if row.kind not in ("late", "absent")]
    if late:
        needs_any = any(row.kind == "absent" for row in late)
        parts.append(f"from typing import TYPE_CHECKING{', Any' * needs_any}\n")
    if imports := "".join(_import_lines([*now, *([_LATE_FUNCTION] if late else [])])):
        parts.append(imports)
    if listed := [row.name for row in now if not row.kind]:
        parts.append(_wrapped("__all__ = [", [f'"{name}"' for name in listed], "]"))
    if late:
        parts.append(_late_text(late))
    return "\n".join(parts)


_LATE_FUNCTION: Final = ImportName("", "import_late_name", "kit.ros.late_names:import_late_name", "")


def _is_alias(row: ImportName) -> bool:
    """Whether type checkers would take an import under another name for a private one."""
    return row.kind != "" and row.name != row.home_name and row.home != TYPE_VARIABLES


def _import_lines(names: Sequence[ImportName]) -> Iterator[str]:
    """Yields the imports of names, home by home, and the aliases made of them."""
    homes: dict[str, list[str]] = defaultdict(list)
    for row in sorted(names, key=lambda row: row.home_name):
        name = f"_{row.name}" if _is_alias(row) else row.name
        is_plain = name == row.home_name and not row.kind
        homes[row.home].append(name if is_plain else f"{row.home_name} as {name}")
    for home in sorted(homes):
        yield _wrapped(f"from {home} import " if home else "import ", homes[home], "")
    if aliases := [f"{row.name} = _{row.name}\n" for row in names if _is_alias(row)]:
        yield "\n" + "".join(aliases)


def _late_text(names: Sequence[ImportName]) -> str:
    """The text that imports names at their first use. Type checkers, which import nothing, read plain imports."""
    there = [row for row in names if row.kind != "absent"]
    seen = indent("".join(_import_lines(there)), "    ")
    seen += "".join(f"    {row.name}: Any\n" for row in names if row.kind == "absent")
    sources = "".join(
        f'        "{row.name}": "{ABSENT * (row.kind == "absent")}{row.source}",\n' for row in names
    )
    return (
        f"if TYPE_CHECKING:\n{seen}else:\n    _LATE_NAMES = {{\n{sources}    }}\n\n"
        "    def __getattr__(name):\n        return import_late_name(__name__, _LATE_NAMES, name)\n"
    )


def _wrapped(start: str, items: Sequence[str], end: str) -> str:
    """One line, or one line for each item where that is too long."""
    line = f"{start}{', '.join(items)}{end}\n"
    if len(line) <= LINE_LENGTH:
        return line
    start, end = (start, end) if end else (f"{start}(", ")")
    return f"{start}\n{''.join(f'    {item},{chr(10)}' for item in items)}{end}\n"


def write_files(folder: Path, table: Path = TABLE) -> None:
    """Writes every module, and removes those that are in the table no more."""
    files = name_files(table)
    for file in folder.rglob("*.py"):
        if str(file.relative_to(folder)) not in files:
            file.unlink()
    for path, text in files.items():
        file = folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    write_files(Path(NAMES_FOLDER))
