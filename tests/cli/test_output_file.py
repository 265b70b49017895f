"""Files to be written: whether they can be is known before the work, and not at its end."""

from __future__ import annotations

from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from kit.cli import main as kit
from kit.cli.output_file import OutputFile


@click.command()
@click.option("--csv", type=OutputFile())
@click.option("--json", type=OutputFile(allow_dash=True))
def work(**_: Path) -> None:
    """Says that it works."""
    click.echo("working")


@pytest.mark.parametrize("option", ["--csv", "--json"])
@pytest.mark.parametrize("name", ["missing/table", "file/table", "."])
def test_what_cannot_be_written_ends_a_command_before_its_work(
    option: str, name: str, tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("")
    ended = CliRunner().invoke(work, [option, str(tmp_path / name)])
    assert ended.exit_code == 2
    assert str(tmp_path) in ended.output
    assert "working" not in ended.output


def test_nothing_is_written_yet_and_what_is_there_stays(tmp_path: Path) -> None:
    (tmp_path / "old").write_text("kept")
    for name in ("old", "new", "/dev/stdout"):
        assert CliRunner().invoke(work, ["--csv", str(tmp_path / name)]).output == "working\n"
    assert CliRunner().invoke(work, ["--json", "-"]).output == "working\n"
    assert [path.name for path in tmp_path.iterdir()] == ["old"]
    assert (tmp_path / "old").read_text() == "kept"


def test_a_sweep_whose_table_has_no_place_trains_nothing(tmp_path: Path) -> None:
    workspace = tmp_path / "ws"
    words = ["sweep", "turn", "--csv", str(tmp_path / "missing" / "table.csv"), "--workspace", str(workspace)]
    ended = CliRunner().invoke(kit, words)
    assert ended.exit_code == 2, ended.output
    assert not list(workspace.rglob("manifest.json"))
