"""Every command says of a name that it does not know the same: what there is not, and the nearest one or what lists them."""

from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli import main

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


def told(folder: Path, words: str) -> str:
    found = CliRunner().invoke(main, words.split(), env={"KIT_WORKSPACE": str(folder), "TERM": "dumb"})
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
