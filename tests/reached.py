"""Runs the tests that a change reaches: ``python -m tests.reached``.

A test file is reached if it, or a module that it imports in turn (inside functions too), was changed; or if its path
mirrors a changed module (``tests/sim/test_physics.py`` of ``kit/sim/physics.py``), as tests of commands and screens may
start them in a process of their own. Changed is what differs from a commit: from the last one, or from ``--since main``.
This is for the time while one works: what goes through a file, a process or a registry can be missed, so the whole suite
runs before a change lands.
"""

from __future__ import annotations

import argparse
import ast
import subprocess
import sys
from collections.abc import Collection, Iterator, Mapping
from functools import cache
from pathlib import Path, PurePosixPath
from types import MappingProxyType
from typing import Final

ROOT: Final = Path(__file__).resolve().parents[1]
CODE: Final = ("kit", "grader", "tests")

TESTS_OF_PATHS: Final[Mapping[str, tuple[str, ...]]] = MappingProxyType(
    {
        "lessons": (
            "tests/test_every_lesson.py",
            "tests/school/lessons",
            "tests/school/quiz",
            "tests/test_readme.py",
        ),
        "maps": ("tests/test_every_map.py", "tests/maps", "tests/test_readme.py"),
        "tests/solutions": ("tests/test_every_lesson.py",),
        "kit": ("tests/test_floors.py",),
        "kit/cli": ("tests/cli",),
        "grader": ("tests/test_floors.py",),
        "grader/cli": ("tests/grader",),
        "README.md": ("tests/test_readme.py",),
        ".github": ("tests/test_readme.py",),
        "pyproject.toml": ("tests/test_floors.py", "tests/test_readme.py"),
    }
)
"""The tests of what no module imports by name, data and commands, by the beginning of its path."""

Imports = Mapping[str, Collection[str]]


def module_name(path: PurePosixPath) -> str:
    """Returns a source file's module name, ``kit.sim.physics`` for ``kit/sim/physics.py``."""
    parts = path.with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def source_files() -> list[PurePosixPath]:
    """Returns every Python file of the product and its tests, solutions of lessons aside."""
    return [
        PurePosixPath(path.relative_to(ROOT).as_posix())
        for room in CODE
        for path in sorted((ROOT / room).rglob("*.py"))
        if "solutions" not in path.parts and "packages" not in path.parts
    ]


def imported_names(tree: ast.Module) -> Iterator[str]:
    """Yields the dotted names that a module imports, at its top and inside functions, and the packages that they are in."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        else:
            continue
        for name in names:
            parts = name.split(".")
            yield from (".".join(parts[:count]) for count in range(1, len(parts) + 1))


@cache
def import_graph() -> tuple[Mapping[str, PurePosixPath], Imports]:
    """Returns every module's file, and which of the others each module imports."""
    files = {module_name(path): path for path in source_files()}
    found: dict[str, set[str]] = {}
    for module, path in files.items():
        names = set(imported_names(ast.parse((ROOT / path).read_text(encoding="utf-8"))))
        # The public surface `kit` imports nothing before it is used, and every module is in it.
        found[module] = (names & files.keys()) - {module, "kit"}
    return files, found


def reach(changed: Collection[str], imports: Imports) -> set[str]:
    """Returns the changed modules and all that import one of them, directly or through others."""
    importers: dict[str, set[str]] = {}
    for module, names in imports.items():
        for name in names:
            importers.setdefault(name, set()).add(module)
    reached, waiting = set(changed), list(changed)
    while waiting:
        for module in importers.get(waiting.pop(), set()) - reached:
            reached.add(module)
            waiting.append(module)
    return reached


def mirrors(changed: PurePosixPath) -> set[str]:
    """Returns the names that a test of this module may have, without their endings."""
    room, *folders, name = changed.with_suffix("").parts
    inside = folders if room == "kit" else [room, *folders]
    own = inside[-1] if name == "__init__" and inside else name
    return {"/".join(["tests", *inside, f"test_{own}{kind}"]) for kind in ("", "_pty")}


def reached_tests(changed: Collection[PurePosixPath]) -> list[str]:
    """Returns the test files and folders that a change of these files reaches, as pytest takes them."""
    files, imports = import_graph()
    modules = {module_name(path) for path in changed if path.suffix == ".py"} & files.keys()
    # A file of data in a package, such as a task, is read by one of the package's modules.
    packages = {".".join(path.parent.parts) for path in changed if path.suffix != ".py"} & files.keys()
    reached = reach(modules | packages, imports)
    mirrored = {name for path in changed if path.parts[0] in {"kit", "grader"} for name in mirrors(path)}
    found = {
        str(path)
        for module, path in files.items()
        if path.name.startswith("test_") and (module in reached or str(path.with_suffix("")) in mirrored)
    }
    for path in changed:
        for beginning, tests in TESTS_OF_PATHS.items():
            if path.is_relative_to(beginning):
                found.update(tests)
    return sorted(found)


def changed_files(since: str) -> list[PurePosixPath]:
    """Returns the paths that differ from a commit, new and removed ones too. Raises CalledProcessError for an unknown one."""

    def lines(*command: str) -> list[str]:
        run = subprocess.run(["git", *command], cwd=ROOT, capture_output=True, text=True, check=True)
        return run.stdout.splitlines()

    return [
        PurePosixPath(line)
        for line in (
            *lines("diff", "--name-only", since, "--"),
            *lines("ls-files", "--others", "--exclude-standard"),
        )
    ]


def main(arguments: list[str]) -> int:
    """Runs pytest with the reached tests and what else it is to be told."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.reached", description="Runs the tests that a change reaches."
    )
    parser.add_argument("--since", default="HEAD", help="the commit to compare with (default: the last)")
    parser.add_argument("--list", action="store_true", help="only print the files")
    own, for_pytest = parser.parse_known_args(arguments)
    try:
        tests = reached_tests(changed_files(own.since))
    except subprocess.CalledProcessError as error:
        print(error.stderr.strip(), file=sys.stderr)
        return 2
    if own.list or not tests:
        print(*(tests or ["No test is reached."]), sep="\n")
        return 0
    if not any(each == "-m" for each in for_pytest):
        for_pytest += ["-m", "not long"]
    return subprocess.run(
        [sys.executable, "-m", "pytest", "-q", *for_pytest, *tests], cwd=ROOT, check=False
    ).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
