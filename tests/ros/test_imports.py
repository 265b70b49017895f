"""The modules of kit.ros do not import each other in circles, and importing them is quick."""

from __future__ import annotations

import ast
import subprocess
import sys
from graphlib import TopologicalSorter
from pathlib import Path

import kit.ros

ROOT = Path(kit.ros.__file__).parent


def module_name(file: Path) -> str:
    parts = ("kit", "ros", *file.relative_to(ROOT).with_suffix("").parts)
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imports_by_module() -> dict[str, set[str]]:
    """The modules of kit.ros that each one imports: at its top, in functions, and under ``TYPE_CHECKING``."""
    files = [
        file for file in ROOT.rglob("*.py") if not {"names", "shims"} & set(file.relative_to(ROOT).parts)
    ]
    modules = {module_name(file): file for file in files}
    imports: dict[str, set[str]] = {}
    for name, file in modules.items():
        found = set()
        for node in ast.walk(ast.parse(file.read_text("utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module is not None:
                found |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
        # Importing a module of a package is no import of the package's other modules.
        imports[name] = {each for each in found & modules.keys() if modules[each].name != "__init__.py"}
    return imports


def test_modules_are_found() -> None:
    imports = imports_by_module()
    assert "kit.ros.graph.directory" in imports["kit.ros.graph.graph"]
    assert "kit.ros.execution.context" in imports["kit.ros.node.endpoint"], "TYPE_CHECKING counts too"


def test_there_are_no_import_circles() -> None:
    TopologicalSorter(imports_by_module()).prepare()  # raises CycleError, which names the modules


def test_a_program_with_a_node_imports_nothing_slow() -> None:
    """Every student's node pays for what ``import rclpy`` brings in."""
    code = (
        "import sys, kit.ros.execution.client_library as rclpy; "
        "print(*sorted({'importlib.abc', 'numba', 'numpy', 'pathlib', 'pymunk', 'yaml'} & sys.modules.keys()))"
    )
    printed = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert printed.stdout.split() == []
