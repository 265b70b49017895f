"""The house rules that a machine can check: floors, names, and what a fresh process must not load."""

from __future__ import annotations

import ast
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from tests.cases import every_case

ROOT = Path(__file__).parent.parent
SOURCES = sorted([*(ROOT / "kit").rglob("*.py"), *(ROOT / "grader").rglob("*.py")])
EMPTY_NAMES = {"utils", "util", "common", "base", "helpers", "core", "manager", "managers", "misc"}
HEAVY = (
    "torch",
    "stable_baselines3",
    "gymnasium",
    "textual",
    "numba",
    "pymunk",
    "PIL",
    "networkx",
    "highspy",
    "rosbags",
)


def test_no_text_has_control_characters() -> None:
    """An editor does not show them. The worlds that are bad on purpose have some."""
    folders = ("kit", "grader", "lessons", "maps", "tests", ".github")
    texts = {
        each
        for name in folders
        for kind in ("py", "pyi", "yaml", "md")
        for each in (ROOT / name).rglob(f"*.{kind}")
    }
    texts = {each for each in texts if "bad_worlds" not in each.parts} | {
        ROOT / "README.md",
        ROOT / "pyproject.toml",
    }
    assert len(texts) > 1000
    allowed = bytes({10, *range(32, 256)} - {127})
    assert {
        str(each.relative_to(ROOT)): rest
        for each in texts
        if (rest := each.read_bytes().translate(None, allowed))
    } == {}


@every_case("source", SOURCES, ids=lambda path: str(path.relative_to(ROOT)))
def test_no_module_is_named_after_nothing(source: Path) -> None:
    if not {"names", "shims"}.intersection(source.parts):  # those are called as ROS and gym call theirs
        assert source.stem not in EMPTY_NAMES


def test_numba_is_imported_by_one_file() -> None:
    jitted = [
        source for source in SOURCES if "import numba" in (text := source.read_text()) or "from numba" in text
    ]
    assert jitted == [ROOT / "kit" / "kernels" / "numba_import.py"]


@pytest.mark.long
def test_no_print_below_the_command_line() -> None:
    printing = [
        str(source.relative_to(ROOT))
        for source in SOURCES
        if not {"cli", "share"} & set(source.parts)  # programs of packages print as ROS 2's do
        for node in ast.walk(ast.parse(source.read_text()))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "print"
    ]
    assert printing == []


def test_imports_go_down() -> None:
    run = subprocess.run(
        [
            sys.executable,
            "-c",
            "import sys; from importlinter.cli import lint_imports; sys.exit(lint_imports())",
        ],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stdout + run.stderr


def test_the_ground_knows_no_messages() -> None:
    """The contract cannot see it: no file holds the modules ``kit.msg.PACKAGE``."""
    layers = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"][0][
        "layers"
    ]
    floors = [layer.split(" : ") for layer in layers]
    beside = next(number for number, rooms in enumerate(floors) if "msg" in rooms)
    ground = {room for rooms in floors[beside:] for room in rooms} - {"msg"}
    assert {"geometry", "arrays"} <= ground
    knowing = [
        str(source.relative_to(ROOT))
        for source in SOURCES
        if source.relative_to(ROOT).with_suffix("").parts[1] in ground
        for node in ast.walk(ast.parse(source.read_text()))
        if isinstance(node, (ast.Import, ast.ImportFrom)) and "kit.msg" in ast.unparse(node)
    ]
    assert knowing == []


def test_the_first_frame_waits_for_no_numbers() -> None:
    """The picture needs them, and is drawn when the frame is on the screen; see ``tests/benchmarks/first_frame.py``."""
    code = "import sys, kit.tui.app, kit.tui.screens.start; print(*{'numpy', 'yaml', 'kit.msg'} & set(sys.modules))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.split() == []


@pytest.mark.parametrize(
    ("module", "allowed"),
    [
        ("kit", ()),
        ("kit.cli", ()),
        ("kit.msg", ()),
        ("kit.ros.names", ()),
        ("kit.host.child.supervisor", ()),
        ("kit.host.child.node_program", ()),
        ("kit.world.records", ()),
        ("kit.render.world_text", ()),
        ("kit.run.runner", ("numba", "pymunk", "PIL")),
        ("kit.layers", ()),
        ("kit.tui.screens.play", ("textual",)),
    ],
)
def test_a_fresh_process_loads_no_more_than_it_needs(module: str, allowed: tuple[str, ...]) -> None:
    unwanted = [name for name in HEAVY if name not in allowed]
    code = f"import sys, {module}; print(*[name for name in {unwanted!r} if name in sys.modules])"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.split() == []
