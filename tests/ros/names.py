"""Prints how many of 178 public ROS 2 programs find here the names that they import, and how many of ROS 2's own are here.

``ros_names.csv`` lists, for each program, the modules and names that it imports, what it reaches as attributes of
``rclpy`` after a plain ``import rclpy``, and the kinds of interfaces that its own package defines. A program counts
as resolved if all of that is found: ``python -m tests.ros.names``, with ``-v`` also what each of the others lacks.

``real_names.csv`` lists the names that rclpy, launch, launch_ros, launch_testing, tf2_ros and message_filters have in Humble,
Jazzy and Rolling, by module: those that a module defines and those that it imports and so offers too.
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

from kit.ros import install_import_names
from kit.ros.late_names import is_absent_name

TABLE: Final = Path(__file__).with_name("ros_names.csv")
REAL_NAMES: Final = Path(__file__).with_name("real_names.csv")

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


def real_names() -> tuple[tuple[str, str], ...]:
    """ROS 2's own names, as pairs of module and name."""
    with REAL_NAMES.open(encoding="utf-8", newline="") as file:
        return tuple(dict.fromkeys((row["module"], row["name"]) for row in csv.DictReader(file)))


def find_unresolved(names: Sequence[tuple[str, str]]) -> list[str]:
    """The names that cannot be imported. The import names must be installed."""
    return [f"{module}.{name}" for module, name in names if not _resolves(module, name)]


def find_absent(names: Sequence[tuple[str, str]]) -> list[str]:
    """The names that are no more than a class which says what they would need."""
    return [
        f"{module}.{name}"
        for module, name in names
        if is_absent_name(getattr(import_module(module), name, None))
    ]


def find_shadowed(names: Sequence[tuple[str, str]]) -> list[str]:
    """The names that a module has from its submodule of the same name, and that are that submodule here.

    Importing a submodule makes it an attribute of its package, so that each is imported before its package is asked.
    """
    modules = {module for module, _ in names}
    return [
        f"{module}.{name}"
        for module, name in names
        if f"{module}.{name}" in modules
        and (f"{module}.{name}", name) in names
        and import_module(f"{module}.{name}") is getattr(import_module(module), name)
    ]


def find_missing(programs: Sequence[Program]) -> dict[int, list[str]]:
    """What each program lacks, by its number. The import names must be installed."""
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
    install_import_names()
    missing = find_missing(read_programs())
    print(f"{sum(not names for names in missing.values())} of {len(missing)} programs find all their names")
    if "-v" in sys.argv[1:]:
        for number, names in missing.items():
            if names:
                print(f"{number:4d}  {' '.join(names)}")
    print("missing, by the number of programs:")
    for name, count in Counter(name for names in missing.values() for name in names).most_common():
        print(f"{count:4d}  {name}")
    names = real_names()
    unresolved = find_unresolved(names)
    absent = () if unresolved else find_absent(names)
    print(
        f"{len(names) - len(unresolved)} of {len(names)} names of ROS 2 can be imported; {len(absent)} of them say at their use what they would need"
    )
    for package in dict.fromkeys(module.partition(".")[0] for module, _ in names):
        count = sum(module.partition(".")[0] == package for module, _ in names)
        left = sum(name.partition(".")[0] == package for name in absent)
        print(f"{count - left:4d} of {count} in {package}")


if __name__ == "__main__":
    main()
