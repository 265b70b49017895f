"""``kit`` alone where there is no full screen: where one stands, and what to type."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.cli.start import SUGGESTED_COMMANDS
from kit.school.progress import FILE, EventKind, ProgressJournal
from kit.tui.terminal import TerminalDecision, TerminalFacts, TerminalOptions, decide_terminal


def output_of(*words: str) -> str:
    result = CliRunner().invoke(main, words, env={"TERM": "dumb"})
    assert result.exit_code == 0, result.output
    return result.output


def test_a_new_student_is_told_where_to_begin() -> None:
    told = output_of()
    assert "Next lesson: `kit lesson A1`" in told
    assert all(line in told for line, _ in SUGGESTED_COMMANDS)


def test_plain_stands_before_the_command_too(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[bool] = []

    def decide(environ: object, facts: TerminalFacts, wishes: TerminalOptions) -> TerminalDecision:
        asked.append(wishes.plain)
        return decide_terminal({}, facts, wishes)

    monkeypatch.setattr("kit.cli.terminal_options.decide_terminal", decide)
    assert "Next lesson: `kit lesson A1`" in output_of("--plain")
    output_of("--plain", "game")
    output_of("game")
    assert asked == [True, True, False]


def test_it_goes_on_where_the_student_left_off(tmp_path: Path) -> None:
    (tmp_path / "home").mkdir()
    with ProgressJournal(tmp_path / "home") as progress:
        progress.add(EventKind.STEP, "01-drive/1")
    assert "Next lesson: `kit lesson A2`" in output_of(
        "start", "--plain", "--workspace", str(tmp_path / "home")
    )


@pytest.mark.long
def test_a_damaged_journal_is_told_and_the_rest_goes_on(tmp_path: Path) -> None:
    (tmp_path / "home").mkdir()
    (tmp_path / "home" / FILE).write_bytes(b"nonsense" * 999)
    told = output_of("start", "--plain", "--workspace", str(tmp_path / "home"))
    assert "was damaged" in told
    assert "kit lesson" in told
