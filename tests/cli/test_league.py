"""``kit league`` without a full screen: enter, list, withdraw, and what is said to a mistake."""

from pathlib import Path

from click.testing import CliRunner

from kit.cli import main
from tests.school.game.league.test_league import CRASHES, LASER


def result_of(folder: Path, *words: str):
    return CliRunner().invoke(main, ["league", "--workspace", str(folder), *words], env={"TERM": "dumb"})


def test_programs_enter_are_listed_and_withdraw(tmp_path: Path) -> None:
    assert "Nobody is entered" in result_of(tmp_path, "--plain").output
    for name, program in {"laser": LASER, "stops": CRASHES}.items():
        (tmp_path / f"{name}.py").write_bytes(program)
        assert result_of(tmp_path, "submit", "--controller", str(tmp_path / f"{name}.py")).exit_code == 0
    listed = result_of(tmp_path, "--plain").output
    assert "laser" in listed
    assert "still to be run" in listed
    assert "(house)" in result_of(tmp_path, "matches").output  # which has met itself
    assert "No match" in result_of(tmp_path, "matches", "laser").output
    assert result_of(tmp_path, "withdraw", "stops").exit_code == 0
    assert "stops" not in result_of(tmp_path, "--plain").output


def test_a_mistake_is_told_in_a_sentence(tmp_path: Path) -> None:
    (tmp_path / "laser.py").write_bytes(LASER)
    file = str(tmp_path / "laser.py")
    assert result_of(tmp_path, "submit", "--controller", file).exit_code == 0
    for words in (
        ("submit",),
        ("submit", "--controller", "nowhere.py"),
        ("submit", "--controller", file, "--name", "../evil"),
        ("submit", "--controller", file, "--name", "again"),
        ("submit", "--controller", "random_walk"),
        ("submit", "--agent", "nobody"),
        ("withdraw", "nobody"),
        ("matches", "nobody"),
        ("replay", "999"),
        ("--folder", str(tmp_path / "nowhere"), "--plain"),
        ("new", str(tmp_path / "class"), "--race", "nowhere"),
        ("new", str(tmp_path / "class"), "--tag", "crossing"),
    ):
        found = result_of(tmp_path, *words)
        assert (found.exit_code, "Traceback" in found.output) == (2, False), (words, found.output)


def test_a_class_has_a_league_in_a_folder(tmp_path: Path) -> None:
    assert (
        result_of(tmp_path, "new", str(tmp_path / "class"), "--title", "3b", "--race", "parking").exit_code
        == 0
    )
    (tmp_path / "laser.py").write_bytes(LASER)
    entered = result_of(
        tmp_path, "--folder", str(tmp_path / "class"), "submit", "--controller", str(tmp_path / "laser.py")
    )
    assert entered.exit_code == 0
    assert (tmp_path / "class/entries/laser.py").read_bytes() == LASER
