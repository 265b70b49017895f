"""A newcomer's way, in a real terminal: draw a map, pose a task, write a reward, train, watch, evaluate, export, race.

No file of the kit is opened: all that is written and edited lies in the newcomer's own folder.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from PIL import Image

from kit.learning.training.run_folders import list_runs
from kit.run.recording import load_recording
from tests.tui.test_play_pty import ROBOT, User, terminals

REWARD = """\
def reward(reached, collided, to_go, previous_to_go):
    return 3.0 * reached - 3.0 * collided + previous_to_go - to_go
"""

Open = Callable[..., User]


@pytest.fixture
def kit() -> Iterator[Open]:
    with terminals() as run:
        yield run
    end_trainings(workspace() / "runs")


def end_trainings(runs: Path) -> None:
    """Stops what is still being trained: it outlives the terminal that began it."""
    for training in list_runs(runs):
        training.send_command("stop")
        end = time.monotonic() + 30
        while training.is_active and time.monotonic() < end:
            time.sleep(0.05)


def workspace() -> Path:
    return Path(os.environ["KIT_WORKSPACE"])


def said(terminal: User) -> str:
    """What a command printed that ended well."""
    code = terminal.wait()
    text = terminal.output.decode(errors="replace")
    assert code == 0, text
    return text


@pytest.mark.long
def test_from_a_drawing_to_a_race(kit: Open, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)

    # A corridor, drawn with the keys: a floor two squares high, the start at its left end, the target at its right.
    sheet = kit("maps", "new", "corridor", "--size", "14x4", "--cell", "0.35")

    def drawn() -> str:
        return "".join(line[:56] for line in sheet.text.splitlines()[1:-2])  # beside the panel

    sheet.until(lambda: "New map corridor" in sheet.text and "[" in drawn(), "the sheet")
    sheet.send(b"3 ")
    sheet.until(lambda: "S" in drawn(), "the start")
    sheet.send(b"4\x1b[F\x1b[D ")
    sheet.until(lambda: "T" in drawn(), "the target")
    sheet.send(b"\x13")
    assert "The path from start to target" in said(sheet)
    world = workspace() / "worlds" / "corridor"

    # A task on it, changed in an editor. And a reward.
    assert "edit it" in said(kit("task", "new", "ahead", "--from", str(world)))
    task = world / "ahead.yaml"
    text = task.read_text()
    assert "name: corridor" in text  # start and target are those that were drawn
    task.write_text(text.replace("sectors: 13", "sectors: 5"))
    (tmp_path / "my_reward.py").write_text(REWARD)
    assert ": valid" in said(kit("task", "check", str(task)))
    assert "elapsed" in said(kit("task", "show", str(task)))

    # Train it from the menu, and watch it learn.
    menu = kit()
    menu.until(lambda: "5  Train" in menu.text and ROBOT.search(menu.text), "the menu")
    menu.send(b"5")
    menu.until(lambda: "No trainings yet" in menu.text, "the trainings")
    menu.send(b"t")
    menu.until(lambda: "A new training" in menu.text, "the form")
    for downs, name in ((0, b"ahead"), (2, b"q-learning"), (2, b"my_reward")):
        menu.send(b"\x1b[B" * downs + b"\r")
        menu.until(lambda: "Enter confirm" in menu.text, "a list")
        menu.send(name + b"\r")
        menu.until(lambda: "Enter confirm" not in menu.text, "the form again")
    menu.until(lambda: "my_reward.py" in menu.text and "q-learning" in menu.text, "all that was chosen")
    menu.send(b"t")
    menu.until(lambda: "steps/s" in menu.text or "finished" in menu.text, "the training", 120)
    menu.send(b"i")
    menu.until(lambda: "value of each action" in menu.text, "what the agent makes of what it perceives", 60)
    menu.until(lambda: "finished" in menu.text.splitlines()[0], "the end of the training", 180)
    menu.send(b"\x1b")
    menu.until(lambda: "all runs:" in menu.text, "the list")
    menu.send(b"e")
    menu.until(lambda: "200 episodes each" in menu.text, "the test", 60)
    menu.send(b"\x03")
    assert menu.wait() == 0

    # Its ways, its node, a race, and a picture of the race.
    (run,) = list_runs(workspace() / "runs")
    assert "worst" in said(kit("evaluate", run.name, "--episodes", "20", "--paths", "2"))
    said(kit("evaluate", run.name, "--node", "agent.py"))
    drive = ("--controller", "agent.py", "--steps", "4000", "--until-reached", "--record", "drive.npz")
    driven = said(kit("run", str(world), *drive))
    assert "reached after" in driven
    assert "First drive: " in said(kit("game", "race", "first-drive", "--agent", run.name))
    recording = tmp_path / "drive.npz"
    assert load_recording(recording).ticks > 100
    said(kit("replay", str(recording), "--export", "race.gif"))
    with Image.open(tmp_path / "race.gif") as picture:
        assert picture.n_frames > 10  # type: ignore[attr-defined]  # of animations alone
