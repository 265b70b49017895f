"""Control groups count what limits of the address space do not, and none is left behind, however the kit ends."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from kit.host.failure import FailureKind, StudentCodeError
from kit.host.sandbox import control_groups
from kit.host.sandbox.control_groups import can_make_groups, remove_free_groups, return_group, take_group
from kit.host.sandbox.limits import GRADER_LIMITS, INTERACTIVE_LIMITS, MIB
from kit.host.sandbox.probe import is_level_available
from kit.host.sandbox.sandbox_config import Level
from kit.host.student_functions import StudentFunctions

ROOT = Path(__file__).parents[3]
pytestmark = pytest.mark.skipif(not can_make_groups(), reason="this user may make no control groups here")

SOURCE = """
import threading

def threads(n):
    threading.stack_size(64 * 1024)
    event, started = threading.Event(), 0
    try:
        for _ in range(n):
            threading.Thread(target=event.wait, daemon=True).start()
            started += 1
    except RuntimeError:
        pass
    event.set()
    return started

def pages(n):
    held = bytearray(n)
    for place in range(0, n, 4096):
        held[place] = 1
    return len(held)
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "work.py"
    path.write_text(SOURCE)
    return path


def without_groups(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("kit.host.process.take_group", lambda limits: None)


@pytest.mark.parametrize("level", [Level.FILTERED, Level.SEPARATE])
def test_threads_of_root_are_counted(level: Level, file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if not is_level_available(level):
        pytest.skip("this machine lacks the level")
    with StudentFunctions(file, limits=GRADER_LIMITS, level=level) as functions:
        assert functions.call_json("threads", {"n": 200}) < 30
    without_groups(monkeypatch)
    if os.geteuid() == 0:
        with StudentFunctions(file, limits=GRADER_LIMITS, level=level) as functions:
            assert functions.call_json("threads", {"n": 200}) == 200


@pytest.mark.parametrize("level", [Level.FILTERED, Level.SEPARATE])
def test_pages_are_counted_besides_addresses(
    level: Level, file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Here the group allows less than the limit of the address space, so that it alone can have ended the program."""
    if not is_level_available(level):
        pytest.skip("this machine lacks the level")
    remove_free_groups()
    monkeypatch.setattr(control_groups, "KERNEL_MEMORY", -900 * MIB)
    with StudentFunctions(file, limits=GRADER_LIMITS, level=level) as functions:
        with pytest.raises(StudentCodeError) as caught:
            functions.call_json("pages", {"n": 400 * MIB})
        assert caught.value.failure.kind is FailureKind.MEMORY
    with StudentFunctions(file, limits=GRADER_LIMITS, level=level) as functions:
        assert functions.call_json("pages", {"n": 10 * MIB}) == 10 * MIB, (
            "the next run is not taken for the last"
        )
    remove_free_groups()
    without_groups(monkeypatch)
    with StudentFunctions(file, limits=GRADER_LIMITS, level=level) as functions:
        assert functions.call_json("pages", {"n": 400 * MIB}) == 400 * MIB


def test_a_group_serves_one_run_after_the_other_and_is_removed() -> None:
    remove_free_groups()
    one, other = take_group(GRADER_LIMITS), take_group(GRADER_LIMITS)
    assert one is not None
    assert other is not None
    assert set(one.folders).isdisjoint(other.folders)
    return_group(one)
    assert take_group(GRADER_LIMITS) is one
    assert take_group(INTERACTIVE_LIMITS) is None, "one's own programs have no such limits"
    for each in (one, other):
        return_group(each)
    remove_free_groups()
    assert not any(Path(folder).exists() for folder in (*one.folders, *other.folders))


def test_what_is_left_in_a_group_is_ended() -> None:
    group = take_group(GRADER_LIMITS)
    assert group is not None
    with subprocess.Popen(["sleep", "3600"]) as left:
        for each in group.member_files:
            Path(each).write_text(str(left.pid))
        group.remove()
        assert all(Path(folder).exists() for folder in group.folders), "a group with members stays"
        left_in = left.pid
        return_group(group)
        assert left.wait(60) == -9, left_in
    remove_free_groups()


STOPPED = """
import os, signal
from kit.host.sandbox.control_groups import take_group
from kit.host.sandbox.limits import GRADER_LIMITS
print(*take_group(GRADER_LIMITS).folders, flush=True)
os.kill(os.getpid(), signal.SIGKILL)
"""


def test_the_groups_of_a_killed_kit_are_removed_at_the_next_start() -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    killed = subprocess.run(
        [sys.executable, "-c", STOPPED], env=environment, capture_output=True, text=True, check=False
    )
    folders = killed.stdout.split()
    assert killed.returncode == -9
    assert len(folders) >= 1
    assert all(Path(each).exists() for each in folders), "nothing else would have removed them"
    goes_on = STOPPED.replace("os.kill(os.getpid(), signal.SIGKILL)", "")
    subprocess.run([sys.executable, "-c", goes_on], env=environment, capture_output=True, check=True)
    assert not any(Path(each).exists() for each in folders)


@pytest.mark.parametrize(
    ("mounts", "own", "handed_down", "place"),
    [
        ("unified", "0::/user/session", {"user": "memory pids"}, "user"),
        ("unified", "0::/user/session", {"user/session": "cpu memory pids"}, "user/session"),
        ("unified", "0::/user/session", {"user": "cpu"}, None),
        ("unified", "0::/", {}, None),
        ("separate", "3:memory:/m\n2:pids:/", {}, "both"),
        ("separate", "3:memory:/m", {}, None),
    ],
)
def test_where_groups_can_be_made(
    mounts: str,
    own: str,
    handed_down: dict[str, str],
    place: str | None,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    kinds = {"unified": [("", "cgroup2")], "separate": [("memory", "cgroup"), ("pids", "cgroup")]}[mounts]
    lines = []
    for name, kind in kinds:
        for folder in ("", "m", "user/session"):
            (tmp_path / name / folder).mkdir(parents=True, exist_ok=True)
        lines.append(f"1 2 0:3 / {tmp_path / name} rw - {kind} {kind} rw,{name}".replace("//", "/"))
    for folder, names in handed_down.items():
        (tmp_path / folder / "cgroup.subtree_control").write_text(names)
    told = {"/proc/self/mountinfo": "\n".join(lines), "/proc/self/cgroup": own}
    read = control_groups._read_group_file
    monkeypatch.setattr(control_groups, "_read_group_file", lambda file: told.get(file) or read(file))
    found = {each.folder for each in control_groups._find_hierarchies()}
    if place is None:
        assert not found
    elif place == "both":
        assert found == {str(tmp_path / "memory" / "m"), str(tmp_path / "pids")}
    else:
        assert found == {str(tmp_path / place)}
