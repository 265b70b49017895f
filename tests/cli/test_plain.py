"""The kit line by line: what is said to it, and what it answers."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from kit.cli import main
from kit.cli.plain import PlainSession, execute_line, run_plain_session
from kit.controllers import find_controller
from kit.run.recording import load_recording, rerun
from kit.run.scenario import find_scenario
from kit.school.progress import EventKind, ProgressJournal
from tests.cases import every_case
from tests.driving_program import driving_program
from tests.kit_content import kit_levels

Say = Callable[[str], str]


@pytest.fixture
def file(tmp_path: Path) -> Path:
    file = tmp_path / "driver.py"
    file.write_text(driving_program(0.2, then="print('going')"))
    return file


@pytest.fixture
def say(file: Path, capsys: pytest.CaptureFixture[str]) -> Iterator[Say]:
    """Says a line to a kit on the simple map, driven by ``file``, and returns the answer."""
    plain = PlainSession(find_scenario("simple"), find_controller(str(file)), seed=0, folder=file.parent)

    def answer(line: str) -> str:
        capsys.readouterr()
        execute_line(plain, line)
        return capsys.readouterr().out

    yield answer
    plain.close()


@pytest.mark.long
def test_a_run_tells_what_was_said_and_where_it_led(say: Say) -> None:
    answer = say("run 1")
    assert "0:00.5 driver: going" in answer or "0:00.6 driver: going" in answer
    assert "distance 0.2 m" in answer


@pytest.mark.long
def test_nothing_that_is_said_is_lost_however_much_was_said_before(say: Say) -> None:
    say("run 25")
    assert say("run 1").count("driver: going") >= 9


@pytest.mark.long
def test_on_another_map_the_controller_drives_too(say: Say) -> None:
    assert "driver drives in Racetrack" in say("map racetrack")
    assert "distance 0.2 m" in say("run 1")


def test_a_map_that_does_not_exist_leaves_everything_as_it_was(say: Say) -> None:
    say("run 1")
    assert "nowhere" in say("map nowhere")
    assert "distance 0.4 m" in say("run 1")


@pytest.mark.long
@pytest.mark.parametrize("place", ["simple", "pair_straight"])
def test_driving_by_hand_moves_the_robot_in_its_namespace_too_and_stops_it(say: Say, place: str) -> None:
    say(f"map {place}")
    assert "distance 0.3 m" in say("drive 0.3 0 1")
    assert "distance 0.3 m" in say("run 1")
    assert "driver drives" in say("controller driver")
    assert "distance 0.5 m" in say("run 1")


@pytest.mark.long
def test_a_saved_controller_is_read_again_and_a_broken_one_leaves_the_old_one(say: Say, file: Path) -> None:
    say("run 1")
    file.write_text("def broken(:\n")
    answer = say("run 1")
    assert "driver.py:1" in answer
    assert "distance 0.4 m" in answer
    file.write_text(driving_program(0.4, then="raise ValueError('enough')"))
    answer = say("run 1")
    assert "driver drives" in answer
    assert "enough" in answer
    assert "at 0:0" in say("run 1")  # the world goes on


@every_case(
    ("line", "word"),
    [
        ("run", "one number"),
        ("run a", "numbers"),
        ("run -1", "above 0"),
        ("run 1e9", "at most"),
        ("drive inf 0 1", "numbers"),
        ("drive 0.1 nan 1", "numbers"),
        ("drive 0.1", "3 numbers"),
        ("map", "name"),
        ("map maze nowhere", "nowhere"),
        ("controller nobody", "nobody"),
        ('map "a', "quotation"),
        ("dance", "help"),
        ("", ""),
        ("# run 1", ""),
    ],
)
def test_a_line_that_cannot_be_done_says_why_and_changes_nothing(say: Say, line: str, word: str) -> None:
    assert word in say(line)
    assert "at 0:00.0" in say("look")


def test_a_world_without_a_robot_cannot_be_driven_but_runs(say: Say, tmp_path: Path) -> None:
    (tmp_path / "world.yaml").write_text("properties: {}\nlayers: []\nmodels: []\n")
    say(f"map {tmp_path}")
    assert "nothing to drive" in say("drive 1 0 1")
    assert "no robot" in say("run 1")


@pytest.mark.long
def test_lines_are_read_until_they_end(tmp_path: Path) -> None:
    desk = ["drive", "--plain", "--workspace", str(tmp_path)]
    ended = CliRunner().invoke(main, desk, input="run 1\nlook")
    assert ended.exit_code == 0
    assert ended.output.count("at 0:01.0") == 2
    left = CliRunner().invoke(main, desk, input="quit\nrun 1\n")
    assert left.exit_code == 0
    assert "at 0:01.0" not in left.output


def test_without_any_standard_input_it_just_ends(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", None)
    plain = PlainSession(find_scenario("simple"), find_controller("forward"), seed=0, folder=tmp_path)
    run_plain_session(plain)
    assert plain.is_over is False


@pytest.mark.parametrize("arguments", [["nowhere"], ["maze", "--case", "x"], ["--controller", "nobody"]])
def test_what_does_not_exist_ends_it_with_a_clear_word(tmp_path: Path, arguments: list[str]) -> None:
    result = CliRunner().invoke(main, ["drive", "--plain", "--workspace", str(tmp_path), *arguments])
    assert result.exit_code == 2
    assert result.exception is None or isinstance(result.exception, SystemExit)
    assert arguments[-1] in result.output


@pytest.mark.long
def test_other_terminals_look_in_while_a_line_is_awaited(tmp_path: Path) -> None:
    environment = {**os.environ, "KIT_WORKSPACE": str(tmp_path)}
    kit = [sys.executable, "-m", "kit"]
    play = subprocess.Popen(
        [*kit, "drive", "simple", "--plain"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env=environment,
        text=True,
    )
    assert play.stdin is not None
    assert play.stdout is not None
    while "Type help" not in play.stdout.readline():
        pass
    seen = subprocess.run([*kit, "ros", "topic", "list"], env=environment, capture_output=True, text=True)
    answer, _ = play.communicate("quit\n", timeout=60)
    assert "/cmd_vel" in seen.stdout, seen.stderr
    assert play.returncode == 0
    assert not answer.strip()
    assert not list((tmp_path / ".running").rglob("*.sock"))


def test_a_drive_is_kept_when_one_leaves(tmp_path: Path) -> None:
    file = tmp_path / "drive.npz"
    desk = ["drive", "simple", "--plain", "--controller", "teleop", "--record", str(file)]
    result = CliRunner().invoke(main, desk, input="drive 0.3 0 1\nrestart\ndrive 0.2 0 1\n")
    assert result.exit_code == 0
    assert str(file) in result.output
    recording = load_recording(file)
    assert recording.ticks == 200
    again = rerun(recording, find_scenario("simple").world)
    assert (again.poses == recording.poses).all()


def test_a_place_that_cannot_be_written_is_told_before_the_drive(tmp_path: Path) -> None:
    desk = ["drive", "simple", "--plain", "--record", str(tmp_path / "none" / "drive.npz")]
    result = CliRunner().invoke(main, desk, input="run 1\n")
    assert result.exit_code == 2
    assert "drive.npz" in result.output
    assert "at 0:01" not in result.output


@every_case(
    "verb", ["keys", "maps new sheet", "layers explain three --screen", "game host two-doors", "game guest"]
)
def test_a_verb_that_is_a_full_screen_alone_says_why_it_has_none(verb: str, tmp_path: Path) -> None:
    runner = CliRunner(env={"KIT_WORKSPACE": str(tmp_path / "robot-kit"), "TERM": "xterm"})
    result = runner.invoke(main, verb.split())
    assert result.exit_code == 2, result.output
    need, _, why = result.stderr.partition("full-screen terminal. ")
    assert need
    assert why


@pytest.mark.long
def test_a_level_that_is_driven_line_by_line_says_how_far_its_goal_is(tmp_path: Path) -> None:
    lines = "drive 0.5 0 3.6\ndrive -0.5 0 3.9\nquit\n"
    arguments = ["game", "--workspace", str(tmp_path), "play", "first-drive", "--plain"]
    result = CliRunner().invoke(main, arguments, input=lines)
    assert result.exit_code == 0, result.output
    begin, there, back = (
        result.output.index(each) for each in ("0 of 2 targets", "1 of 2 targets", "finished after")
    )
    assert begin < there < back
    with ProgressJournal(tmp_path) as journal:
        (event,) = journal.events(EventKind.FINISH)
    assert event.content["reached"] is True


def test_a_level_that_is_not_open_is_refused_with_what_opens_it(tmp_path: Path) -> None:
    def game(*arguments: str) -> Result:
        return CliRunner().invoke(main, ["game", "--workspace", str(tmp_path), *arguments], input="quit\n")

    level = next(each for each in kit_levels() if each.opened_by == ("first-drive",))
    for arguments in (("play", level.id, "--plain"), ("race", level.id, "--controller", "forward")):
        refused = game(*arguments)
        assert refused.exit_code == 2, refused.output
        assert f"{level.title} opens after First drive or lesson {level.lesson_number}" in refused.stderr
    with ProgressJournal(tmp_path) as journal:
        assert not journal.events(EventKind.FINISH)
        content = {"reached": True, "seconds": 5.0, "bumps": 0, "driver": "hand", "medal": 1}
        journal.add(EventKind.FINISH, "first-drive", content)
    assert game("play", level.id, "--plain").exit_code == 0
