"""Every command says of a name that it does not know the same: what there is not, and the nearest one or what lists them."""

from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.school.game.challenges import find_challenge
from kit.school.game.levels import find_level

NEAR = {
    "game frist-drive": '"first-drive"',
    "lesson driv": 'A2, "Drive"',
    "quiz driv": 'A2, "Drive"',
    "maps show maz": '"maze"',
    "train trn": '"turn"',
    "glossary polcy": '"policy"',
    "help desgn": '"design"',
    "study 5.22": '"5.2"',
    "run maze --controller rndom_walk": '"random_walk"',
    "train turn --algo pppo": '"ppo"',
    "layers plan mazze": '"maze"',
}
FAR = {
    "game zzz": "kit game",
    "lesson Z9": "kit lesson",
    "maps show qqq": "kit maps",
    "train qqq": "kit train --list",
    "glossary qqqq": "kit glossary",
}
COMMANDS = {
    "game leaderbord": "kit game leaderboard",
    "maps shw": "kit maps show",
    "task shw": "kit task show",
    "league submt": "kit league submit",
    "progress exprt": "kit progress export",
    "quiz today": "kit quiz --today",
    "replay nothing": "kit game replay LEVEL",
}
"""What was typed, and the command that is offered."""


def told(folder: Path, words: str) -> str:
    found = CliRunner().invoke(
        main, words.split(), prog_name="kit", env={"KIT_WORKSPACE": str(folder), "TERM": "dumb"}
    )
    assert found.exit_code == 2
    return f"{found.output}{found.exception or ''}"


@pytest.mark.parametrize("words", NEAR)
def test_the_nearest_name_is_offered(words: str, tmp_path: Path) -> None:
    text = told(tmp_path, words)
    assert "There is no " in text
    assert f"did you mean {NEAR[words]}?" in " ".join(text.split())


@pytest.mark.parametrize("words", FAR)
def test_what_lists_them_is_named_where_none_is_near(words: str, tmp_path: Path) -> None:
    text = told(tmp_path, words)
    assert "There is no " in text
    assert f"`{FAR[words]}` lists them" in " ".join(text.split())


@pytest.mark.parametrize("words", COMMANDS)
def test_the_command_that_is_meant_is_offered(words: str, tmp_path: Path) -> None:
    assert f"`{COMMANDS[words]}`" in " ".join(told(tmp_path, words).split())


@pytest.mark.parametrize("words", ["replay drve.npz", "progress import drve.npz"])
def test_the_nearest_file_is_offered(words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "drive.npz").touch()
    monkeypatch.chdir(tmp_path)
    assert "id you mean drive.npz?" in " ".join(told(tmp_path, words).split())


def test_titles_are_names_too() -> None:
    assert find_level("Left turn").id == "left-turn"
    assert find_challenge("a free lunch").id == "free-lunch"
