"""``kit run``, ``kit replay`` and ``kit maps``, as they are typed."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result

import kit as kit_package
from kit.cli import main
from kit.inspection.sockets import running_worlds, sockets_folder
from kit.msg.geometry_msgs import Twist, Vector3
from kit.ros.bags import read_bag, read_messages
from kit.run.episode import run_until
from kit.run.recording import Recorder, load_recording, save_recording
from kit.run.session import Session
from kit.school.game.levels import find_level
from kit.world.catalogue import maps_folder
from tests.tui.input.conftest import Terminal
from tests.waiting import wait_until

TALKER = """
import rclpy
from rclpy.node import Node

class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.create_timer(0.5, self.go)

    def go(self):
        self.get_logger().warning("logged")
        print("printed")
"""


def kit(*words: str | Path) -> Result:
    result = CliRunner().invoke(main, [str(word) for word in words])
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result


@pytest.mark.parametrize("name", ["my\\{}", "MY/{}", "C:\\my\\{}", "~/nowhere/my/{}"])
@pytest.mark.parametrize(
    ("words", "file"),
    [
        (("run",), "room.yaml"),
        (("run", "simple", "--steps", "1", "--controller"), "drive.py"),
        (("world", "check"), "room.yaml"),
        (("launch",), "room.launch.py"),
        (("maps", "from-photo", "--width", "4"), "room.png"),
        (("train", "turn", "--imitate"), "drive.npz"),
    ],
)
def test_a_path_as_windows_users_write_it_gets_the_name_that_is_there(
    words: tuple[str, ...], file: str, name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "my").mkdir()
    (tmp_path / "my" / file).touch()
    monkeypatch.chdir(tmp_path)
    result = kit(*words, name.format(file))
    assert "Did you mean" in result.output
    assert f"my/{file}" in result.output.replace("\n", " ")
    assert result.exit_code != 0


@pytest.mark.long
def test_the_same_words_give_the_same_run_to_the_bit() -> None:
    words = ("run", "maze", "--steps", "700", "--json", "--seed")
    runs = [json.loads(kit(*words, seed).stdout) for seed in ("1", "1", "2")]
    assert runs[0] | {"wall_s": 0} == runs[1] | {"wall_s": 0}
    assert runs[0]["fingerprint"] != runs[2]["fingerprint"]


def test_what_the_controller_says_goes_to_standard_error(tmp_path: Path) -> None:
    (tmp_path / "talker.py").write_text(TALKER)
    result = kit("run", "simple", "--controller", tmp_path / "talker.py", "--steps", "120", "--json")
    assert json.loads(result.stdout)["ticks"] == 120
    assert result.stderr.count("logged") == 2
    assert result.stderr.count("talker: printed") == 2
    assert "0:00.5 talker: logged" in result.stderr


def test_what_is_left_out_of_a_flood_is_said(tmp_path: Path) -> None:
    (tmp_path / "flood.py").write_text('print("x" * 5000)\n' + TALKER)
    result = kit("run", "simple", "--controller", tmp_path / "flood.py", "--steps", "10")
    assert "3,000 bytes" in result.stderr


def test_a_controller_of_the_workspace_is_found_from_anywhere(tmp_path: Path) -> None:
    (tmp_path / "controllers").mkdir()
    (tmp_path / "controllers" / "mine.py").write_text(TALKER)
    for name in ("mine", "mine.py"):
        words = ("--workspace", tmp_path, "--steps", "5", "--json", "--controller", name)
        assert json.loads(kit("run", "simple", *words).stdout)["controller"] == "mine"
    missing = kit("run", "simple", "--workspace", tmp_path, "--controller", "yours.py")
    assert missing.exit_code == 2
    assert str(tmp_path / "controllers") in missing.stderr


def test_a_map_of_the_workspace_is_found_by_its_name(tmp_path: Path) -> None:
    folder = tmp_path / "workspace" / "worlds" / "mine"
    shutil.copytree(maps_folder() / "simple", folder)
    shutil.copytree(maps_folder() / "robots", folder / "robots")
    world = folder / "world.yaml"
    world.write_text(world.read_text().replace("../robots", "robots"))
    shown = [json.loads(kit("run", name, "--steps", "3", "--json").stdout) for name in ("simple", "mine")]
    assert shown[0]["fingerprint"] == shown[1]["fingerprint"]
    assert "mine" in kit("world", "check", "mine").stdout


@pytest.mark.parametrize("place", ["nowhere", "/nonexistent/world.yaml", "~nobody-of-that-name/world.yaml"])
def test_a_place_that_does_not_exist_is_an_error_in_words(place: str) -> None:
    result = kit("run", place)
    assert result.exit_code == 2
    assert "Traceback" not in result.stderr


def test_a_run_without_a_step_does_not_deny_the_target(tmp_path: Path) -> None:
    (tmp_path / "broken.py").write_text("def main(:\n")
    result = CliRunner().invoke(main, ["run", "maze", "--controller", str(tmp_path / "broken.py")])
    assert result.exit_code == 1
    assert "broken.py:1" in result.output
    assert "none in this world" not in result.output


def test_a_controller_that_is_no_python_file_says_what_it_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder").mkdir()
    (tmp_path / "binary.yaml").write_bytes(b"\0")
    os.mkfifo(tmp_path / "fifo.py")
    for name, kind in {
        "folder": "a folder",
        "binary.yaml": "another kind",
        "fifo.py": "not a regular file",
    }.items():
        result = CliRunner().invoke(main, ["run", "maze", "--controller", name])
        assert result.exit_code == 2
        assert kind in result.output


def test_a_home_that_nobody_has_is_an_error_in_words(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("KIT_WORKSPACE", raising=False)
    monkeypatch.setattr("os.path.expanduser", lambda path: path)
    result = kit("run", "maze")
    assert result.exit_code == 2
    assert "--workspace" in result.stderr


@pytest.mark.long
@pytest.mark.parametrize(
    "sent", ["SIGINT", "SIGTERM", "SIGHUP", "SIGTERM SIGTERM", "SIGINT SIGTERM", "hang up"]
)
def test_every_end_keeps_what_was_recorded(tmp_path: Path, sent: str) -> None:
    """The terminal is the user's, so that the controller has one of its own too."""
    file, bag = tmp_path / "run.npz", tmp_path / "bag"
    (tmp_path / "talker.py").write_text(TALKER)
    words = ("run", "maze", "--controller", tmp_path / "talker.py", "--steps", "100000000", "--speed", "20")
    main_file = Path(kit_package.__file__).with_name("__main__.py")
    with closing(Terminal(*map(str, (main_file, *words, "--record", file, "--bag", bag)))) as terminal:
        terminal.until(lambda: b"printed" in terminal.output, "the run")
        if sent == "hang up":
            terminal.hang_up()
            terminal.process.wait(60)
        else:
            for name in sent.split():
                terminal.process.send_signal(signal.Signals[name])
            terminal.wait()
            assert terminal.process.returncode != 0
            terminal.assert_sane()
    if " " not in sent:
        first = signal.SIGHUP if sent == "hang up" else signal.Signals[sent]
        assert terminal.process.returncode == 128 + first
        assert sent == "hang up" or str(file).encode() in terminal.output.replace(b"\r\n", b"")
    assert load_recording(file).ticks >= 50
    assert kit("replay", file, "--check").exit_code == 0
    assert sum(1 for _ in read_messages(bag)) == read_bag(bag).count > 0
    assert {each.name for each in tmp_path.iterdir()} == {"run.npz", "bag", "talker.py"}


@pytest.mark.parametrize("where", ["no/such/folder/run.npz", "file/run.npz"])
def test_a_recording_that_cannot_be_written_is_refused_before_the_run(tmp_path: Path, where: str) -> None:
    (tmp_path / "file").touch()
    start = time.monotonic()
    result = kit("run", "maze", "--steps", "100000000", "--record", tmp_path / where)
    assert result.exit_code == 2
    assert str(tmp_path / where) in result.stderr
    assert time.monotonic() - start < 20


def test_a_run_is_kept_and_runs_again(tmp_path: Path) -> None:
    file = tmp_path / "run.npz"
    assert kit("run", "maze", "--steps", "300", "--record", file).exit_code == 0
    again = kit("replay", "--check", file)
    assert again.exit_code == 0
    assert "to the bit" in again.stdout
    _change(file, seed=7)  # other noise, other ranges; but what it was told is the same
    assert kit("replay", "--check", file).exit_code == 0
    _change(file, inputs=[])
    other = kit("replay", "--check", file)
    assert other.exit_code == 1
    assert "not the same run" in other.stdout


TWIST = "geometry_msgs/msg/Twist"


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The recording of a short run."""
    file = tmp_path_factory.mktemp("recording") / "run.npz"
    kit("run", "maze", "--steps", "20", "--record", file)
    return file.read_bytes()


@pytest.mark.parametrize(
    "damage",
    [
        {"format": 99},
        {"place": "nowhere"},
        {"step_size": -1},
        {"step_size": "nan"},
        {"inputs": 5},
        {"inputs": [[3, "explode", []]]},
        {"inputs": [[3, "accept", ["/cmd_vel", "no/msg/Such", {}]]]},
        {"inputs": [[3, "accept", ["/cmd_vel", "std_srvs/srv/Empty", {}]]]},
        {"inputs": [[3, "accept", ["/cmd_vel", "std_msgs/msg/String", {}]]]},
        {"inputs": [[3, "accept", ["/cmd_vel", TWIST, {"a": 1}]]]},
        {"inputs": [[3, "accept", []]]},
        {"inputs": [[3, "move_model", ["nobody", [0, 0, 0]]]]},
        {"inputs": [[3, "spawn_model", ["/etc/passwd", "a", "", [0, 0, 0]]]]},
    ],
    ids=str,
)
def test_a_damaged_recording_is_an_error_in_words(
    tmp_path: Path, recording: bytes, damage: dict[str, Any]
) -> None:
    file = tmp_path / "run.npz"
    file.write_bytes(recording)
    _change(file, **damage)
    result = kit("replay", "--check", file)
    assert result.exit_code == 2
    assert result.stderr


@pytest.mark.parametrize("content", [b"", b"text", b"PK\x03\x04" + bytes(200)])
def test_a_foreign_file_is_no_recording(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "run.npz"
    file.write_bytes(content)
    assert kit("replay", "--check", file).exit_code == 2
    file.unlink()
    assert f"There is no recording {file}" in kit("replay", "--check", file).stderr


def test_a_recording_cut_short_is_no_recording(tmp_path: Path) -> None:
    file = tmp_path / "run.npz"
    kit("run", "maze", "--steps", "50", "--record", file)
    whole = file.read_bytes()
    for length in range(0, len(whole), 97):
        file.write_bytes(whole[:length])
        assert kit("replay", "--check", file).exit_code == 2


@pytest.mark.long
def test_ctrl_c_ends_the_run_with_its_summary(tmp_path: Path) -> None:
    words = [
        sys.executable,
        "-m",
        "kit",
        "run",
        "maze",
        "--steps",
        "1000000000",
        "--json",
        "--speed",
        "1",
        "--serve",
    ]
    process = subprocess.Popen([*words, "--workspace", str(tmp_path)], stdout=subprocess.PIPE, text=True)
    sockets = sockets_folder(tmp_path)
    wait_until(lambda: running_worlds(sockets), "the world's socket")
    time.sleep(1.0)  # it is then on its way; nothing outside tells how far
    os.kill(process.pid, signal.SIGINT)
    out, _ = process.communicate(timeout=20)
    assert process.returncode == 130
    assert json.loads(out)["interrupted"] is True


def test_a_map_in_characters_that_the_terminal_has() -> None:
    assert "maze" in kit("maps").stdout
    assert kit("maps", "maze", "--glyphs", "ascii").stdout.isascii()
    assert kit("maps", "nowhere").exit_code == 2


def test_a_map_whose_world_is_wrong_is_told_with_its_place(tmp_path: Path) -> None:
    made = shutil.copytree(maps_folder() / "maze", tmp_path / "maze")
    (made / "world.yaml").write_text((made / "world.yaml").read_text().replace("../robots", "../models"))
    refused = kit("maps", made)
    assert refused.exit_code == 2
    assert "world.yaml:" in refused.stderr


def _change(file: Path, **parts: Any) -> None:
    """Replaces parts of a recording's header."""
    arrays = dict(np.load(file))
    header = json.loads(bytes(arrays["header"])) | parts
    arrays["header"] = np.frombuffer(json.dumps(header).encode(), np.uint8)
    with file.open("wb") as opened:
        np.savez(opened, **arrays)


@pytest.mark.parametrize("level", ["black-ice", "corridor-traffic"])
def test_a_drive_on_a_level_is_replayed_under_its_conditions(level: str, tmp_path: Path) -> None:
    scenario = find_level(level).find_scenario()
    with Session(scenario, seed=1) as session:
        recorder = Recorder.for_scenario(scenario, session.runner.simulation)
        session.runner.observers.append(recorder)
        for topic in session.command_topics(scenario.partners[0]):
            session.runner.accept(topic, Twist(linear=Vector3(x=0.5)))
        run_until(session.runner, ticks=50)
    drive, file = recorder.recording(), tmp_path / "drive.npz"
    save_recording(drive, file)
    assert load_recording(file).level == level
    assert kit("replay", "--check", file).exit_code == 0
    save_recording(replace(drive, level=None), file)
    assert load_recording(file).level is None
    assert kit("replay", "--check", file).exit_code == 1  # the same drive without the level's conditions
    save_recording(replace(drive, level="gone"), file)
    gone = kit("replay", "--check", file)
    assert gone.exit_code == 2
    assert "gone" in gone.stderr


@pytest.mark.parametrize(
    ("controller", "topic", "said"),
    [
        ("random_walk", "scan", ("/static_laser", "/scan")),  # as most public robots call it
        ("mine", "static_laser", ("/scan", "/static_laser")),
        ("random_walk", "static_laser", ()),
        ("mine", "scan", ()),
    ],
)
def test_a_controller_that_hears_nothing_says_what_it_waits_for_and_what_there_is(
    tmp_path: Path, controller: str, topic: str, said: tuple[str, ...]
) -> None:
    (tmp_path / "world.yaml").write_text(
        "properties: {}\nlayers: []\nmodels: [{name: b, model: b.model.yaml, pose: [0, 0, 0]}]\n"
    )
    (tmp_path / "b.model.yaml").write_text(
        "bodies: [{name: base, type: dynamic, footprints: [{type: circle, radius: 0.1, density: 1}]}]\n"
        "plugins:\n- {type: DiffDrive, name: drive, body: base}\n"
        "- {type: Laser, name: eyes, body: base, range: 3, topic: TOPIC, angle: {min: -1, max: 1, increment: 0.1}}\n".replace(
            "TOPIC", topic
        )
    )
    (tmp_path / "mine.py").write_text(
        TALKER.replace(
            "self.create_timer(0.5, self.go)", 'self.create_subscription(LaserScan, "scan", print, 1)'
        ).replace("import rclpy\n", "import rclpy\nfrom sensor_msgs.msg import LaserScan\n")
    )
    name = controller if controller == "random_walk" else tmp_path / "mine.py"
    result = kit("run", tmp_path / "world.yaml", "--controller", name, "--steps", "60")
    lines = [
        line for line in result.stderr.splitlines() if "has no publisher" in line and "laser" in line.lower()
    ]
    assert len(lines) == bool(said)
    assert all(each in lines[0] for each in said)
