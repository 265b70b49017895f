"""Prints how many of 178 public ROS 2 programs find here the names that they import.

``ros_names.csv`` lists, for each program, the modules and names that it imports, what it reaches as attributes of
``rclpy`` after a plain ``import rclpy``, and the kinds of interfaces that its own package defines. A program counts
as resolved if all of that is found: ``python -m tests.ros.names``, with ``-v`` also what each of the others lacks.
"""

from __future__ import annotations

import csv
import sys
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Final

from kit.ros import names_folder

TABLE: Final = Path(__file__).with_name("ros_names.csv")

OWN_INTERFACES: Final = frozenset({"msg", "srv", "action"})
"""The kinds of interfaces that a package may define itself; ``tests/launch/test_own_interfaces.py`` runs such packages."""


WORKSPACE_PACKAGES: Final = frozenset(
    {"crazy_turtle_interfaces", "package_with_interfaces", "python_package_with_a_library"}
)
"""Packages that lie beside the programs in their own repositories, so that a workspace has them: own interfaces under
another name, and a program's own modules. The same tests run such workspaces."""


@dataclass(frozen=True)
class Program:
    """A row of the table."""

    number: int
    imports: tuple[str, ...]
    """``module`` or ``module:name``."""
    attributes: tuple[str, ...]
    """``rclpy.name``."""
    own_interfaces: tuple[str, ...]

    def missing_attributes(self) -> list[str]:
        """What ``import rclpy``, with the program's own other imports, does not bring. To be called before any import
        of another program's, since whatever is imported once stays an attribute of its package."""
        imported = {entry.partition(":")[0] for entry in self.imports}
        rclpy = import_module("rclpy")
        return [
            name
            for name in self.attributes
            if not hasattr(rclpy, name.partition(".")[2]) and not (name in imported and _resolves(name, ""))
        ]

    def missing_imports(self) -> list[str]:
        """The imports that fail, and the kinds of interfaces that a package cannot define itself."""
        missing = [
            entry
            for entry in self.imports
            if entry.partition(".")[0] not in WORKSPACE_PACKAGES and not _resolves(*entry.partition(":")[::2])
        ]
        return missing + [f"own {kind}" for kind in self.own_interfaces if kind not in OWN_INTERFACES]


def read_programs() -> tuple[Program, ...]:
    """The table's rows."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))[1:]
    return tuple(Program(int(number), *(tuple(cell.split()) for cell in cells)) for number, *cells in rows)


def find_missing(programs: Sequence[Program]) -> dict[int, list[str]]:
    """What each program lacks, by its number. ``names_folder()`` must be on ``sys.path``."""
    missing = {program.number: program.missing_attributes() for program in programs}
    for program in programs:
        missing[program.number] += program.missing_imports()
    return missing


def _resolves(module: str, name: str) -> bool:
    """True if ``from module import name`` works; without a name, ``import module``."""
    try:
        found = import_module(module)
        if not name or hasattr(found, name):
            return True
        import_module(f"{module}.{name}")
    except ImportError:
        return False
    return True


def main() -> None:
    sys.path.insert(0, names_folder())
    missing = find_missing(read_programs())
    print(f"{sum(not names for names in missing.values())} of {len(missing)} programs find all their names")
    if "-v" in sys.argv[1:]:
        for number, names in missing.items():
            if names:
                print(f"{number:4d}  {' '.join(names)}")
    print("missing, by the number of programs:")
    for name, count in Counter(name for names in missing.values() for name in names).most_common():
        print(f"{count:4d}  {name}")


if __name__ == "__main__":
    main()
