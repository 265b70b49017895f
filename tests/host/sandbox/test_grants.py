"""What lies beside the kit's own half, where packages are installed, cannot be read; every other package can."""

from __future__ import annotations

import ast
import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from kit.host.program_start import process_environment
from kit.host.sandbox import grants
from kit.host.sandbox.grants import find_grants
from kit.host.sandbox.namespaces import FileTree, plan_mounts
from kit.host.sandbox.probe import is_level_available
from kit.host.sandbox.sandbox_config import Level, SandboxConfig
from kit.host.student_functions import StudentFunctions
from tests.host.conftest import QUICK, Student

pytestmark = pytest.mark.usefixtures("cold_start")

SECRETS = (
    "kit/data/solutions/01/controller.py",
    "kit/data/lessons/01/secret.yaml",
    "kit/data/lessons/01/reference.py",
    "kit/sim/__init__.py",
    "grader/__init__.py",
    "robot_learning_kit-0.1.0.dist-info/RECORD",
    "_editable_impl_robot_learning_kit.pth",
)
PUBLIC = ("beside/__init__.py", "alone.py", "kitchen/__init__.py", "beside-1.dist-info/METADATA")


@pytest.fixture
def library(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of installed packages with a copy of the kit and of the grader, and a link to each."""
    folder = tmp_path / "python" / "site-packages"
    for name in (*SECRETS, *PUBLIC):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text("'something'\n")
    (folder / "alias").symlink_to("kit")
    (folder / "aside").symlink_to(folder / "kit" / "data")
    (tmp_path / "python" / "lib64").symlink_to("site-packages")
    monkeypatch.syspath_prepend(str(folder))
    # Granted as a whole, if nothing hid in it.
    monkeypatch.setattr(grants, "_SYSTEM", (*grants._SYSTEM, str(tmp_path / "python")))
    return folder


@pytest.mark.long
@pytest.mark.parametrize("level", [level for level in Level if level])
def test_every_package_but_ours_can_be_read(student: Student, library: Path, level: Level) -> None:
    if not is_level_available(level):
        pytest.skip("not on this machine")
    file = student(
        """
        def read(path):
            try: return len(open(path).read())
            except OSError: return 0

        def imports(name):
            try: return 1 if __import__(name).__file__ else 0  # no file: a folder in which nothing is to be seen
            except (ImportError, OSError): return 0
        """
    )
    hidden = [library / name for name in SECRETS]
    hidden += [library / "alias" / SECRETS[0][4:], library / "aside" / "solutions/01/controller.py"]
    hidden += [library.parent / "lib64" / name for name in SECRETS]
    with StudentFunctions(file, limits=QUICK, level=level) as functions:
        assert not any(functions.call_batch("read", [{"path": str(path)} for path in hidden]))
        assert all(functions.call_batch("read", [{"path": str(library / name)} for name in PUBLIC]))
        names = ["beside", "alone", "kitchen", "kit.host", "kit.msg", "kit.ros", "kit.geometry", "numpy"]
        assert all(functions.call_batch("imports", [{"name": name} for name in names]))
        assert not any(
            functions.call_batch("imports", [{"name": name} for name in ("kit.sim", "grader", "alias.sim")])
        )


def _imports(module: ast.AST) -> Iterator[str]:
    """The modules of the kit that are imported when the code runs: not those that a type checker alone imports."""
    for node in ast.iter_child_nodes(module):
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            continue
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("kit."):
            yield node.module or ""
        elif isinstance(node, ast.Import):
            yield from (each.name for each in node.names if each.name.startswith("kit."))
        yield from _imports(node)


def test_all_that_a_students_process_imports_of_the_kit_is_granted() -> None:
    kit = Path(grants.__file__).parents[2]
    parts = tuple(f"kit.{Path(part).stem}" for part in grants._KIT_PARTS)
    own = [kit / part for part in grants._KIT_PARTS if part.endswith(".py")]
    for folder in ("host/child", "msg", "ros"):
        own += (kit / folder).rglob("*.py")
    assert {
        f"{file.relative_to(kit)}: {name}"
        for file in own
        if file.name != "__init__.py" or file.parent != kit  # whose names are imported when they are used
        for name in _imports(ast.parse(file.read_text("utf-8")))
        if not name.startswith(tuple(f"{part}." for part in parts)) and name not in parts
    } == set()


def test_nothing_of_ours_lies_below_what_is_granted(library: Path) -> None:
    granted = find_grants([Path("/nowhere")])
    readable = [Path(path).resolve() for path in granted.readable]
    for name in SECRETS:
        assert not any((library / name).is_relative_to(path) for path in readable)
    assert {str(library), str(library.parent)} <= set(granted.listed)
    ours = Path(sys.modules["kit"].__path__[0])
    assert ours / "sim" not in readable
    assert not any((ours / "sim" / "simulation.py").is_relative_to(path) for path in readable)


def test_what_is_installed_meanwhile_is_granted_too(library: Path) -> None:
    before = find_grants([Path("/nowhere")])
    os.utime(library, (1, 1))
    assert find_grants([Path("/nowhere")]) == before
    (library / "later.py").write_text("")
    (library / "robot_learning_kit-9.dist-info").mkdir()
    after = find_grants([Path("/nowhere")])
    added = {Path(path).resolve() for path in set(after.readable) - set(before.readable)}
    assert added == {library / "later.py"}
    assert set(after.hidden) - set(before.hidden) == {str(library / "robot_learning_kit-9.dist-info")}


def test_a_folder_is_mounted_once_and_what_is_hidden_in_it_is_covered(tmp_path: Path) -> None:
    inner = tmp_path / "site-packages" / "kit" / "host"
    inner.mkdir(parents=True)
    (tmp_path / "link").symlink_to(inner)
    (tmp_path / "lib64").symlink_to("site-packages")
    readable = [inner, tmp_path / "link", tmp_path / "site-packages", tmp_path / "lib64", tmp_path / "no"]
    hidden = [tmp_path / "site-packages" / "kit", tmp_path / "elsewhere"]
    plan = [
        (Path(mount.name).relative_to(tmp_path).as_posix(), mount.real is not None)
        for mount in plan_mounts(FileTree([*map(str, readable)], (), [*map(str, hidden)]))
    ]
    assert plan[:3] == [("link", True), ("lib64", True), ("lib64/kit", False)]
    assert plan[3:] == [
        ("site-packages", True),
        ("site-packages/kit", False),
        ("site-packages/kit/host", True),
    ]


def test_few_mounts_whatever_is_installed() -> None:
    """Hundreds of packages lie in one folder, and each mount takes time."""
    granted = find_grants([Path("/nowhere")])
    config = SandboxConfig(
        Level.SEPARATE, QUICK, "/nowhere", granted.readable, granted.listed, granted.hidden
    )
    assert len(list(plan_mounts(config.file_tree))) < 60


def test_the_environment_grants_no_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whoever sets LD_LIBRARY_PATH to a workspace grants nothing of it; a cluster's libraries of this Python stay usable."""
    workspace, cluster = tmp_path / "workspace", tmp_path / "cluster"
    for folder in (workspace, cluster):
        folder.mkdir()
        for name in ("secret.yaml", "libown.so.1"):
            (folder / name).write_text("x")
    maps = tmp_path / "maps"
    maps.write_text(f"7f00-7f01 r-xp 00000000 08:01 1234       {cluster}/libown.so.1\n")
    monkeypatch.setenv("LD_LIBRARY_PATH", f"{workspace}:{cluster}:relative:")
    monkeypatch.setattr(grants, "MAPPED_FILES", str(maps))
    assert grants.loader_folders() == [str(cluster)]
    readable = find_grants([Path("/nowhere")]).readable
    below = [path for path in readable if path.startswith(str(tmp_path))]
    assert below == [f"{cluster}/libown.so.1"]
    assert process_environment("/scratch")["LD_LIBRARY_PATH"] == str(cluster)
    monkeypatch.setenv("LD_LIBRARY_PATH", str(workspace))
    assert "LD_LIBRARY_PATH" not in process_environment("/scratch")
