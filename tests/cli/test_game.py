"""``kit game``: its lists and replays without a full screen."""

import datetime
from pathlib import Path
from types import SimpleNamespace

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.school.game.daily import daily_level, today
from kit.school.game.drive_records import begin_run
from kit.school.progress import ProgressJournal


def result_of(folder: Path, *words: str):
    return CliRunner().invoke(main, ["game", "--workspace", str(folder), *words], env={"TERM": "dumb"})


def test_a_replay_without_a_full_screen_says_whose_drive_it_is_and_how_long(tmp_path: Path) -> None:
    found = result_of(tmp_path, "replay", "first-drive")
    assert found.exit_code == 0
    assert "reference" in found.output
    assert " s." in found.output
    missing = result_of(tmp_path, "replay", "first-drive", "--driver", "hand")
    assert missing.exit_code == 2
    assert "no drive" in missing.output


def test_a_race_of_a_program_that_stops_fails_and_says_where(tmp_path: Path) -> None:
    program = tmp_path / "driver.py"
    program.write_text("import rclpy\n\n\ndef main():\n    raise KeyError('no wheel')\n")
    found = result_of(tmp_path, "race", "first-drive", "--controller", str(program))
    assert found.exit_code == 1
    assert "driver.py:5" in found.output


def test_the_maze_of_a_day_is_neither_driven_before_it_comes_nor_shown_before_it_is_driven(
    tmp_path: Path,
) -> None:
    tomorrow = today() + datetime.timedelta(days=1)
    for words in (("play", "--plain"), ("race", "--controller", "odometry"), ("replay",)):
        found = result_of(tmp_path, words[0], f"daily-{tomorrow}", *words[1:])
        assert found.exit_code == 2
        assert "comes on its day" in found.output
    of_today = daily_level(today())
    assert result_of(tmp_path, "replay", of_today.id).exit_code == 2
    with ProgressJournal(tmp_path) as journal:
        begin_run(journal, of_today)
    assert "reference" in result_of(tmp_path, "replay", of_today.id).output


def test_a_level_is_played_by_its_name_alone(tmp_path: Path) -> None:
    assert 'did you mean "first-drive"?' in result_of(tmp_path, "frist-drive").output
    by_name, by_command = (
        result_of(tmp_path, *words) for words in (("first-drive",), ("play", "first-drive"))
    )
    assert by_name.output.splitlines()[0] == by_command.output.splitlines()[0]
    assert "First drive" in by_name.output


def test_the_daily_on_a_screen_tells_nothing_before_it_that_its_end_contradicts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown: list[str] = []

    def show_levels(*arguments: object) -> None:
        shown.append("levels")
        raise SystemExit(0)

    monkeypatch.setattr("kit.cli.game.show_levels", show_levels)
    monkeypatch.setattr(
        "kit.cli.game.terminal_options.decide",
        lambda plain=False: SimpleNamespace(plain=SimpleNamespace(value=False)),
    )
    assert not result_of(tmp_path, "daily").output
    assert shown
