"""A training on the screen, in a real terminal: watched, paused, left and found again, stopped and taken up."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from pathlib import Path

import pytest

from kit.learning.training.runs import TrainingRun
from tests.test_newcomer_pty import end_trainings
from tests.tui.test_play_pty import ROBOT, User, resize, terminals
from tests.tui.widgets.test_world_view_pty import run_on

TABLE = ("train", "turn", "--algo", "q-learning", "--name", "mine")
"""A table learns without the extra, and slowly enough to be looked at."""
STEPS = re.compile(r"([\d,]+) of [\d,]+ steps")

Open = Callable[..., User]


@pytest.fixture
def kit() -> Iterator[Open]:
    with terminals() as run:
        yield run
    end_trainings(Path(os.environ["KIT_WORKSPACE"]) / "runs")


def the_run(name: str = "mine") -> TrainingRun:
    return TrainingRun(Path(os.environ["KIT_WORKSPACE"]) / "runs" / name)


def steps(terminal: User) -> int:
    found = STEPS.search(terminal.text)
    return int(found[1].replace(",", "")) if found else 0


@pytest.mark.long
def test_a_training_is_watched_paused_left_found_again_stopped_and_taken_up(kit: Open) -> None:
    terminal = kit(*TABLE, "--keep-training", "--steps", "100000000")
    terminal.until(lambda: "training" in terminal.text.splitlines()[0], "the training")
    terminal.until(lambda: steps(terminal) > 0 and "█reached" in terminal.text, "its figures and outcomes")
    for part in ("1 training", "a_to_b", "b_to_a", "steps/s", "p pause", "it continues"):
        terminal.until(lambda part=part: part in terminal.text, part)
    terminal.until(lambda: ROBOT.search(terminal.text), "the robot with the newest policy")
    terminal.send(b"p")
    terminal.until(
        lambda: "paused" in terminal.text.splitlines()[0] and "p continue" in terminal.text, "the pause"
    )
    run_on(terminal, 1.0)  # the update that was under way when the key came
    before = steps(terminal)
    run_on(terminal, 1.2)
    assert steps(terminal) == before
    terminal.send(b"p")
    terminal.until(lambda: steps(terminal) > before, "the training to go on")
    terminal.send(b"\x1b")
    assert terminal.wait() == 0
    terminal.assert_sane()
    assert b"mine continues training. `kit watch mine`" in terminal.output
    assert the_run().is_active

    again = kit("watch", "mine")
    again.until(lambda: steps(again) >= before and ROBOT.search(again.text), "all of it again")
    again.send(b"k")
    again.until(lambda: "stopped" in again.text.splitlines()[0], "the stop")
    assert not the_run().is_active
    assert "p continues" in again.text
    before = steps(again)
    again.send(b"p")
    again.until(lambda: "training" in again.text.splitlines()[0] and steps(again) > before, "a new learner")
    again.send(b"\x03")
    assert again.wait() == 0
    again.assert_sane()
    assert the_run().is_active

    lines = kit("watch", "mine", "--once")
    assert lines.wait() == 0
    assert b"continues from the last checkpoint" in lines.output
    assert b"\x1b" not in lines.output


@pytest.mark.long
def test_it_is_found_from_the_play_screen_and_looked_at_in_any_size(kit: Open) -> None:
    started = kit(*TABLE, "--detach", "--keep-training", "--steps", "100000000")
    assert started.wait() == 0
    terminal = kit("drive", "simple", "--glyphs", "ascii")
    terminal.until(lambda: "0:0" in terminal.text, "a world")
    terminal.send(b"t")
    terminal.until(lambda: "Trainings" in terminal.text and "mine" in terminal.text, "the list")
    terminal.send(b"\r")
    terminal.until(lambda: "steps/s" in terminal.text and "#reached" in terminal.text, "the training")
    terminal.until(lambda: re.search(r"turn_\w+  after", terminal.text), "the robot")
    assert terminal.text.isascii()
    terminal.send(b"\t")
    terminal.until(lambda: "last 10 batches" in terminal.text, "the reward by term")
    terminal.until(lambda: "forward" in terminal.text, "forward")
    terminal.send(b"y")
    terminal.until(lambda: "reward in training" in terminal.text, "the reward's curve")
    for size in ((200, 50), (40, 10), (1, 1), (90, 15)):
        resize(terminal, *size)
        run_on(terminal, 0.3)
    resize(terminal, 200, 50)
    terminal.until(
        lambda: "a_to_b" in terminal.text and "reward per episode" in terminal.text, "both at once"
    )
    resize(terminal, 80, 24)
    terminal.until(lambda: "steps/s" in terminal.text, "the usual size")
    terminal.send(b"m")
    terminal.until(lambda: "Which case" in terminal.text, "the cases")
    terminal.send(b"b_to_a\r")
    terminal.until(lambda: re.search(r"turn_b_to_a  after", terminal.text), "the robot on that case")
    terminal.send(b"\x1b")
    terminal.until(lambda: "all runs:" in terminal.text, "the list again")
    terminal.send(b"\x1b")
    terminal.until(lambda: "speed x1" in terminal.text, "the world again, and running")
    terminal.send(b"\x03")
    assert terminal.wait() == 0
    terminal.assert_sane()
    assert the_run().is_active


@pytest.mark.long
@pytest.mark.skipif(find_spec("torch") is None, reason="the extra learn is not installed")
def test_a_network_learns_and_its_policy_drives_without_torch_in_the_face(kit: Open) -> None:
    terminal = kit("train", "turn", "--steps", "40000", "--name", "deep")
    terminal.until(
        lambda: "finished" in terminal.text and ROBOT.search(terminal.text), "the end and the robot", 90
    )
    terminal.send(b"n")
    terminal.until(lambda: "best" in terminal.text, "the best policy at the wheel")
    assert "torch" not in Path(f"/proc/{terminal.process.pid}/maps").read_text()
    terminal.send(b"\x03")
    assert terminal.wait() == 0
    assert b"kit evaluate deep" in terminal.output
