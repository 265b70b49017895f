"""How large and how tangled the code is, with the figures of the first build beside each: ``python tests/benchmarks/house.py``.

Counts modules, lines, import circles, seams, functions that only forward and repeated class names.
``--tests`` also times the README's test command (minutes). The figures are no quota: they tell whether it got simpler.
"""

from __future__ import annotations

import ast
import re
import statistics
import subprocess
import sys
import time
import tomllib
from argparse import ArgumentParser
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import networkx

ROOT: Final = Path(__file__).resolve().parents[2]

FIXED_BY_ROS: Final = frozenset({"msg", "names", "shims"})
"""Folders whose class names ROS, gym or pynput prescribe."""

STARTER_NAME: Final = "starter"
"""A module whose classes the solution beside it defines too: it is the same program, unfinished."""

NAMED_TWICE_BY_ROS: Final = {
    "EventHandler": "of rclpy.event_handler, and of launch",
    "IncludeLaunchDescription": "of launch.actions, and of launch.events",
    "LifecycleNode": "of rclpy.lifecycle, and of launch_ros.actions",
    "Node": "of rclpy.node, and of launch_ros.actions",
    "Parameter": "of rclpy.parameter, and of launch_ros.parameter_descriptions",
    "Shutdown": "of launch.actions, and of launch.events",
}
"""Classes of two modules of ROS 2 that have one name there, and so here."""


@dataclass(frozen=True, slots=True)
class Figure:
    """One line of the report."""

    name: str
    now: str
    first_build: str


def sources() -> list[Path]:
    """Every module of the product."""
    return sorted(path for room in ("kit", "grader") for path in (ROOT / room).rglob("*.py"))


def module_name(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


class _Imports(ast.NodeVisitor):
    """Collects (imported name, how): at import time, inside a function, or for type checkers alone."""

    def __init__(self) -> None:
        self.found: list[tuple[str, str]] = []
        self._how = "import"

    def visit_If(self, node: ast.If) -> None:
        if "TYPE_CHECKING" in ast.unparse(node.test):
            self._within("typing", node.body)
            self._within(self._how, node.orelse)
        else:
            self.generic_visit(node)

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        self._within("function" if self._how == "import" else self._how, node.body)

    def visit_AsyncFunctionDef(self, node: ast.AsyncFunctionDef) -> None:
        self._within("function" if self._how == "import" else self._how, node.body)

    def visit_Import(self, node: ast.Import) -> None:
        self.found += [(alias.name, self._how) for alias in node.names]

    def visit_ImportFrom(self, node: ast.ImportFrom) -> None:
        self.found += [(f"{node.module}.{alias.name}", self._how) for alias in node.names]

    def _within(self, how: str, body: list[ast.stmt]) -> None:
        before, self._how = self._how, how
        for statement in body:
            self.visit(statement)
        self._how = before


def import_edges(trees: dict[str, ast.Module]) -> dict[str, set[tuple[str, str]]]:
    """For each way of importing, the pairs (module, imported module) inside the product."""
    edges: dict[str, set[tuple[str, str]]] = defaultdict(set)
    for module, tree in trees.items():
        visitor = _Imports()
        visitor.visit(tree)
        for name, how in visitor.found:
            target = name if name in trees else name.rpartition(".")[0]
            if target in trees and target != module:
                edges[how].add((module, target))
    return edges


def circles(edges: set[tuple[str, str]]) -> str:
    """The sizes of the strongly connected groups of more than one module, largest first."""
    groups = networkx.strongly_connected_components(networkx.DiGraph(sorted(edges)))
    sizes = sorted((len(group) for group in groups if len(group) > 1), reverse=True)
    return ", ".join(map(str, sizes)) or "none"


def circle_members(edges: set[tuple[str, str]]) -> list[str]:
    """The modules of each such group, as one line."""
    groups = networkx.strongly_connected_components(networkx.DiGraph(sorted(edges)))
    return sorted(" <-> ".join(sorted(group)) for group in groups if len(group) > 1)


def seams(tree: ast.Module) -> int:
    """How often constants follow a definition: a sign that a module was put together from several.

    A constant that names what is defined above it (a table of functions, the type of a class) belongs there.
    """
    found = 0
    was_definition = False
    defined: set[str] = set()
    for node in tree.body:
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            was_definition = True
            defined.add(node.name)
        elif isinstance(node, (ast.Assign, ast.AnnAssign)) and node.value is not None:
            names = {each.id for each in ast.walk(node) if isinstance(each, ast.Name)}
            if was_definition and not names & defined:
                found += 1
                was_definition = False
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            defined |= (
                {each.id for each in targets if isinstance(each, ast.Name)} if names & defined else set()
            )
    return found


def forwards(function: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    """Whether a function only calls one of another object with its own arguments, in their order."""
    body = [
        node
        for node in function.body
        if not (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant))
    ]
    if len(body) != 1 or not isinstance(body[0], (ast.Return, ast.Expr)) or function.decorator_list:
        return False
    call = body[0].value
    call = call.value if isinstance(call, ast.Await) else call
    if not isinstance(call, ast.Call) or not isinstance(call.func, ast.Attribute) or call.keywords:
        return False
    parts = call.func.value
    own = [each.arg for each in function.args.args if each.arg not in ("self", "cls")]
    given = [each.id if isinstance(each, ast.Name) else "" for each in call.args]
    return isinstance(parts, ast.Attribute) and own == given


def functions(tree: ast.AST) -> Iterator[ast.FunctionDef | ast.AsyncFunctionDef]:
    return (node for node in ast.walk(tree) if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)))


def late_imports(tree: ast.Module) -> int:
    """The number of import statements inside functions."""
    return len(
        {
            (node.lineno, node.col_offset)
            for function in functions(tree)
            for node in ast.walk(function)
            if isinstance(node, (ast.Import, ast.ImportFrom))
        }
    )


def typing_blocks(tree: ast.Module) -> int:
    """The number of blocks that only type checkers read."""
    return sum(
        isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test) for node in ast.walk(tree)
    )


def header_lines(tree: ast.Module) -> int:
    """Lines before the first definition: docstring, imports, blank lines."""
    for node in tree.body:
        if isinstance(node, (ast.ImportFrom, ast.Import)) or (
            isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        ):
            continue
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            continue
        return node.lineno - 1
    return max((node.end_lineno or 0 for node in tree.body), default=0)


def repeated_classes(trees: dict[str, ast.Module]) -> list[str]:
    """Public and private class names that more than one module defines, ROS's own aside."""
    places: dict[str, set[str]] = defaultdict(set)
    for module, tree in trees.items():
        if not (FIXED_BY_ROS | {STARTER_NAME}).intersection(module.split(".")):
            for node in ast.walk(tree):
                if isinstance(node, ast.ClassDef):
                    places[node.name].add(module)
    twice = {name for name, modules in places.items() if len(modules) > 1}
    return sorted(twice - NAMED_TWICE_BY_ROS.keys())


def figures() -> tuple[list[Figure], list[str]]:
    """Every figure that reading the code gives; and the names behind them: circles, modules with two seams or more,
    functions that forward, class names that are defined twice."""
    paths = sources()
    texts = {module_name(path): path.read_text(encoding="utf-8") for path in paths}
    trees = {module: ast.parse(text) for module, text in texts.items()}
    lines = {module: len(text.splitlines()) for module, text in texts.items()}
    edges = import_edges(trees)
    at_import = edges["import"]
    at_run_time = at_import | edges["function"]
    lengths = [
        (node.end_lineno or node.lineno) - node.lineno + 1
        for tree in trees.values()
        for node in functions(tree)
    ]
    headers = sum(header_lines(tree) for tree in trees.values())
    contract = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"][
        "contracts"
    ]
    layers = next(each["layers"] for each in contract if each["type"] == "layers")
    children = [path for path in (ROOT / "kit").iterdir() if not path.name.startswith(("_", "."))]
    repeated = repeated_classes(trees)
    product = {module: tree for module, tree in trees.items() if not FIXED_BY_ROS & set(module.split("."))}
    everything = at_run_time | edges["typing"]
    sewn = [f"seams: {seams(tree)} {module}" for module, tree in product.items() if seams(tree) > 1]
    forwarding = [
        f"forwards: {module}:{node.lineno} {node.name}"
        for module, tree in product.items()
        for node in functions(tree)
        if forwards(node)
    ]
    tests = sum(len(path.read_text(encoding="utf-8").splitlines()) for path in (ROOT / "tests").rglob("*.py"))
    made = sum(count for module, count in lines.items() if "names" in module.split("."))
    rows = [
        Figure("imports inside functions", str(sum(map(late_imports, product.values()))), "374"),
        Figure("blocks for type checkers alone", str(sum(map(typing_blocks, product.values()))), "101"),
        Figure("import circles at import time", circles(at_import), "none"),
        Figure("import circles at run time", circles(at_run_time), "4, 4, 2"),
        Figure("import circles with typing", circles(everything), "27, 7, 4"),
        Figure("children of kit/, and grader", str(len(children) + 1), "36"),
        Figure("layers of the import contract", str(len(layers)), "13"),
        Figure("modules", str(len(paths)), "716"),
        Figure("product lines", f"{sum(lines.values()):,}", "78,956"),
        Figure("  of these ROS's import names, written from a table", f"{made:,}", "0"),
        Figure("test lines", f"{tests:,}", ""),
        Figure("modules with two seams or more", str(len(sewn)), ""),
        Figure("functions that only forward", str(len(forwarding)), ""),
        Figure("class names defined twice, ROS's aside", str(len(repeated)), "115"),
        Figure("lines of the median module", f"{statistics.median(lines.values()):.0f}", "96"),
        Figure("lines of the median function", f"{statistics.median(lengths):.0f}", "5"),
        Figure("share of header lines", f"{headers / sum(lines.values()):.1%}", "13.9%"),
    ]
    circular = [f"circle: {each}" for each in circle_members(everything)]
    return rows, [*circular, *sewn, *forwarding, *(f"twice: {each}" for each in repeated)]


def test_seconds() -> Figure:
    """The README's test command without its installation, timed."""
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    command = re.search(r"(-m pytest -q [^\n`]*)", readme)
    assert command is not None
    begun = time.monotonic()
    subprocess.run(f"{sys.executable} {command[1]}", shell=True, cwd=ROOT, check=True)
    return Figure("seconds of the test command", f"{time.monotonic() - begun:.0f}", "about 600")


def main() -> None:
    """Prints the report."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument(
        "--names",
        action="store_true",
        help="also list what is counted, with its place: circles, seams, functions that only forward, class names",
    )
    parser.add_argument("--tests", action="store_true", help="also time the README's test command")
    given = parser.parse_args()
    rows, names = figures()
    if given.tests:
        rows.append(test_seconds())
    width = max(len(row.name) for row in rows)
    print(f"{'':{width}}  {'now':>10}  first build")
    for row in rows:
        print(f"{row.name:{width}}  {row.now:>10}  {row.first_build}")
    if given.names:
        print(*names, sep="\n")


if __name__ == "__main__":
    main()
