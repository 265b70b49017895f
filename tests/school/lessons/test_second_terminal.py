"""How to open a second terminal, for each place at which a student may sit."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.school.lessons.markup import parse_markup, plain_text, wrap_blocks
from kit.school.lessons.shell_lines import second_terminal_text

SSH = "192.0.2.7 50022 198.51.100.4 22"


@pytest.mark.parametrize(
    ("environ", "commands"),
    [
        ({}, ["tmux", "kit"]),
        ({"SSH_CONNECTION": SSH}, ["ssh ada@198.51.100.4", "tmux", "kit"]),
        ({"SSH_CONNECTION": SSH, "TMUX": "/tmp/tmux-0/default,1,0"}, []),
    ],
)
def test_the_commands_fit_the_connection(environ: dict[str, str], commands: list[str]) -> None:
    text = second_terminal_text(environ, user="ada", activate=None, workspace=None)
    rows = [plain_text(row) for row in wrap_blocks(parse_markup(text), 76)]
    assert [row.strip() for row in rows if row.startswith("    ")] == commands
    assert len(rows) <= 22


def test_a_new_shell_is_told_where_the_kit_and_the_files_are() -> None:
    text = second_terminal_text(
        {}, user="ada", activate=Path("/opt/kit/bin/activate"), workspace=Path("/data/my work")
    )
    assert "    source /opt/kit/bin/activate\n    export KIT_WORKSPACE='/data/my work'" in text
