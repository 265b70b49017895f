"""What is missing or wrong in a package or its launch file: said, with the place, and nothing left running."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path

import pytest

from kit.launch.launch_file_process import find_launch_file
from kit.ros.packages import PackageError
from tests.launch.conftest import TWO_ROBOTS, Launched, Workshop, kit
from tests.waiting import wait_until

SERVER = "Node(package='flatland_server', executable='flatland_server', parameters=[{{{}}}]),"

WRONG = {
    "unknown package": (
        "Node(package='planners', executable='planner'),",
        "bad.launch.py:12: package 'planners' not found",
        2,
    ),
    "unknown program": (
        "Node(package='bad', executable='runn'),",
        "has no executable 'runn'; it has: run",
        2,
    ),
    "unknown command": ("ExecuteProcess(cmd=['no_such_program']),", "'no_such_program' cannot be started", 2),
    "unknown argument": (
        "LogInfo(msg=LaunchConfiguration('x')),",
        "launch/bad.launch.py:12: launch configuration 'x'",
        2,
    ),
    "needed argument": (
        "DeclareLaunchArgument('x'),",
        "launch/bad.launch.py:12: Required launch argument 'x'",
        2,
    ),
    "no world path": (SERVER.format("'update_rate': 100.0"), "the parameter 'world_path' is missing", 2),
    "no such world": (SERVER.format("'world_path': '/nowhere.yaml'"), "/nowhere.yaml", 2),
    "bad rate": (
        SERVER.format("'world_path': 'x', 'update_rate': 'fast'"),
        "'update_rate' must be a number above 0",
        2,
    ),
    "bad show_viz": (
        SERVER.format("'world_path': 'x', 'show_viz': 'often'"),
        "'show_viz' must be true or false",
        2,
    ),
    "typing error": (SERVER.format("'world_path': 'x', 'updaterate': 9.0"), "did you mean 'update_rate'?", 2),
    "two worlds": (2 * SERVER.format("'world_path': 'x'"), "one flatland_server", 2),
    "no transform": (
        "Node(package='tf2_ros', executable='static_transform_publisher', arguments=['1']),",
        "x y z yaw",
        2,
    ),
    "wrong types": (
        "Node(package='bad', executable='run', parameters=[{'speed': object()}]),",
        "no parameter can hold",
        2,
    ),
    "wrong keyword": ("Node(package='bad', executable='run', ouput='screen'),", "has no argument 'ouput'", 2),
    "python error": ("LogInfo(msg=1 / 0),", "launch/bad.launch.py:12: ZeroDivisionError", 2),
    "no entity": (
        "42,",
        "launch/bad.launch.py:11: TypeError: an action, or a list of actions, is needed here",
        2,
    ),
    "belongs to ROS 2": (
        "ExecuteTest(cmd=[]),",
        "name 'ExecuteTest' is not defined",
        2,
    ),
    "include cycle": ("IncludeLaunchDescription(ThisLaunchFile()),", "include each other without end", 2),
    "name of a node": (
        "Node(package='bad', executable='run', name='9lives'),",
        "node name must not start with a number",
        1,
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_errors_of_a_launch_file_are_explained(case: str, launch: Launched, workshop: Workshop) -> None:
    body, message, expected = WRONG[case]
    folder = workshop.package("bad", body, run="self.get_logger().info('runs')")
    out, err, code = launch(folder, "--until", "0.2")
    assert message in err, out + err
    assert "Traceback" not in out + err
    assert code == expected


FAILING = {
    "import": (
        "import no_such_library\ndef main(): pass\n",
        "bad/run.py:1: ModuleNotFoundError",
        "pip install no_such_library",
    ),
    "ros import": (
        "from nav2_msgs.msg import Path\ndef main(): pass\n",
        "No module named 'nav2_msgs'",
        "navigation is C++",
    ),
    "missing name": (
        "from std_msgs.msg import Sting\ndef main(): pass\n",
        "cannot import name 'Sting'",
        "Did you mean 'String'?",
    ),
    "syntax": ("def main(:\n    pass\n", "bad/run.py:1: SyntaxError", ""),
    "callback": ("self.create_timer(0.01, lambda: 1 / 0)", "bad/run.py:9: ZeroDivisionError", ""),
    "no main": ("x = 1\ndef main_(): pass\n", "bad.run has no main()", ""),
    "exit code": ("def main():\n    return 7\n", "exit code 7", "exited with status 7"),
}


@pytest.mark.parametrize("case", FAILING)
def test_a_program_that_fails_is_named_and_the_rest_goes_on(
    case: str, launch: Launched, workshop: Workshop
) -> None:
    source, message, advice = FAILING[case]
    folder = workshop.package(
        "bad",
        "Node(package='bad', executable='run'), Node(package='bad', executable='good'),",
        run=source,
        good="self.create_timer(0.1, lambda: self.get_logger().info('still here'))",
    )
    out, err, code = launch(folder, "--until", "0.5")
    assert "[ERROR] [run-1]: process has died" in err
    assert message in err
    assert advice in err
    assert "still here" in out + err
    assert code == 1


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("/nowhere",), "no such file, folder or package"),
        ((TWO_ROBOTS, "other.launch.py"), "available: two_robots.launch.py"),
        ((TWO_ROBOTS / "setup.cfg",), "NAME.launch.py"),
        ((TWO_ROBOTS, "a", "b"), "NAME:=VALUE"),
        ((TWO_ROBOTS / "world",), "no package.xml"),
        ((TWO_ROBOTS, "learn:=perhaps", "--plain"), "Valid options are"),
    ],
)
def test_missing_files_and_packages_are_named(
    words: tuple[str | Path, ...], message: str, launch: Launched
) -> None:
    out, err, code = launch(*words)
    assert message in err
    assert "Traceback" not in out + err
    assert code == 2


def test_a_broken_package_is_named_with_its_line(
    launch: Launched, workshop: Workshop, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = workshop.package("torn", "LogInfo(msg='one'),")
    manifest = folder / "package.xml"
    lines = manifest.read_text("utf-8").splitlines()
    manifest.write_text("\n".join([*lines[:-1], "</license>", lines[-1]]), "utf-8")
    monkeypatch.chdir(tmp_path)
    for words in ((folder.parent,), ("torn",)):
        _, err, code = launch(*words)
        assert f"{manifest}:{len(lines)}:" in err
        assert "broken XML" in err
        assert code == 2


def test_several_launch_files_must_be_chosen_from(launch: Launched, workshop: Workshop) -> None:
    folder = workshop.package("many", "LogInfo(msg='one'),")
    (folder / "launch" / "two.launch.py").write_text("")
    _, err, code = launch(folder)
    assert "many.launch.py, two.launch.py" in err
    assert code == 2
    out, _, code = launch(folder, "many.launch.py", "--plain")
    assert "[launch]: one" in out
    assert code == 0


def test_a_launch_file_that_starts_nothing_says_so(launch: Launched, workshop: Workshop) -> None:
    out, _, code = launch(workshop.package("hollow", ""), "--plain")
    assert "hollow.launch.py starts no program" in out
    assert code == 0


def children(pid: int) -> list[int]:
    """A process's descendants."""
    found = []
    for task in Path(f"/proc/{pid}/task").glob("*/children"):
        for child in map(int, task.read_text().split()):
            found += [child, *children(child)]
    return found


@pytest.mark.long
@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="needs Linux's /proc")
@pytest.mark.parametrize(
    ("state", "number"),
    [
        ("starting", signal.SIGINT),
        ("running", signal.SIGINT),
        ("busy", signal.SIGINT),
        ("stubborn", signal.SIGINT),
        ("running", signal.SIGTERM),
        ("running", signal.SIGHUP),
    ],
)
def test_a_signal_ends_everything_in_every_state(
    state: str, number: signal.Signals, workshop: Workshop, tmp_path: Path
) -> None:
    programs = {
        "starting": "import time\ntime.sleep = None\nimport select\nselect.select([], [], [], 60)\ndef main(): pass\n",
        "running": "self.get_logger().info('runs')",
        "busy": "self.create_timer(0.01, self.work)\n\n    def work(self):\n        while True: pass",
        "stubborn": "self.get_logger().info('runs')",
    }
    command = "trap '' INT TERM; sleep 60" if state == "stubborn" else "sleep 60"
    folder = workshop.package(
        "state",
        f"ExecuteProcess(cmd=['sh', '-c', {command!r}]), Node(package='state', executable='run'),",
        run=programs[state],
    )
    with kit(tmp_path / "workspace", "launch", folder, "--plain") as process:
        assert process.stdout is not None
        begun = any("process started" in line for line in process.stdout)
        assert begun
        if state != "starting":
            time.sleep(0.5)
        started = children(process.pid)
        assert started
        process.send_signal(number)
        rest, _ = process.communicate(timeout=20)
        assert "Traceback" not in rest
        assert process.returncode == 128 + number
    wait_until(lambda: not any(Path(f"/proc/{pid}").exists() and not _is_zombie(pid) for pid in started))
    assert not list((tmp_path / "workspace" / ".running").rglob("*.sock"))


def _is_zombie(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


def test_a_user_s_print_and_log_lines_cannot_steer_the_terminal(launch: Launched, workshop: Workshop) -> None:
    folder = workshop.package(
        "loud",
        "ExecuteProcess(cmd=['printf', '\\x1b[2J\\x07hello\\n']),",
    )
    out, _, _ = launch(folder, "--plain")
    assert "hello" in out
    assert "\x1b" not in out
    assert os.linesep in out


def test_a_workspace_without_a_place_for_a_socket_is_no_hindrance(
    launch: Launched, workshop: Workshop, tmp_path: Path
) -> None:
    (tmp_path / "workspace").mkdir()
    (tmp_path / "workspace" / ".running").write_text("no folder")
    out, err, code = launch(workshop.package("small", "LogInfo(msg='goes on'),"), "--plain")
    assert "goes on" in out
    assert "other terminals cannot connect" in err
    assert code == 0


def test_a_word_after_a_launch_file_is_no_argument_and_is_refused(tmp_path: Path) -> None:
    """``who=x`` for ``who:=x``: it was left out without a word, and the default was used."""
    file = tmp_path / "a.launch.py"
    file.write_text("")
    assert find_launch_file(str(file), None, ()).file == file
    with pytest.raises(PackageError, match="NAME:=VALUE"):
        find_launch_file(str(file), "who=x", ())


@pytest.mark.parametrize(
    ("manifest", "has_siblings"), [("<package format='3'><name>one</name></package>", True), (None, False)]
)
def test_only_a_package_has_siblings(tmp_path: Path, manifest: str | None, has_siblings: bool) -> None:
    """Above a launch file that lies in no package may lie anything, up to the whole disk."""
    folder = tmp_path / "one"
    folder.mkdir()
    file = folder / "drive.launch.py"
    file.write_text("")
    if manifest is not None:
        (folder / "package.xml").write_text(manifest)
    search = find_launch_file(str(file), None, ()).search
    assert folder in search
    assert (tmp_path in search) == has_siblings
