"""``kit doctor``: pasteable text, the same as JSON, and right about what it was asked."""

from __future__ import annotations

import json
import os
import pty
import re
import select
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli import doctor
from kit.cli.doctor import command
from kit.installation import install_command
from kit.school import class_costs
from kit.school.capacity import MachineSize, UseCost


def report(*arguments: str, **environ: str) -> str:
    result = CliRunner().invoke(command, arguments, env={"TERM": "xterm", **environ})
    assert result.exit_code == 0, result.output
    return result.output


def test_it_is_plain_text_that_fits_into_80_columns() -> None:
    text = report(KIT_WORKSPACE="/home/someone/robot-kit")
    long_words = re.compile(r"\S{60,}")  # a path is not broken
    assert all(len(line) <= 80 for line in text.splitlines() if not long_words.search(line))
    assert text.isascii()
    assert "\x1b" not in text


@pytest.mark.long
def test_json_says_the_same() -> None:
    before, sections, after = report(), json.loads(report("--json")), report()
    text = f"{before}\n{after}"  # meanwhile another test may have compiled what was not compiled yet
    for section, entries in sections.items():
        assert f"\n{section}\n" in f"\n{text}"
        for name, entry in entries.items():
            assert re.search(rf"^  {re.escape(name)} +{re.escape(entry['value'].split()[0])}", text, re.M)
    assert sections["Machine"]["python"]["value"] == ".".join(map(str, sys.version_info[:3]))
    assert sections["Packages"]["textual"]["value"] == "8.2.8"


def test_it_reports_decisions_with_reasons() -> None:
    terminal = json.loads(report("--json", SSH_CONNECTION="a 1 b 22", NO_COLOR="1", TERM="tmux-256color"))[
        "Terminal"
    ]
    assert terminal["screen"]["value"] == "plain text"
    assert terminal["colours"] == {"value": "none", "meaning": "NO_COLOR is set."}
    assert terminal["in between"]["value"] == "tmux"
    assert "ssh -C" in terminal["tip"]["value"]


def test_no_tip_about_ssh_without_ssh() -> None:
    names = ("SSH_CONNECTION", "SSH_TTY", "SSH_CLIENT")
    assert "tip" not in json.loads(report("--json", **dict.fromkeys(names, "")))["Terminal"]


def test_what_is_missing_of_the_extra_is_named_with_the_way_out(monkeypatch: pytest.MonkeyPatch) -> None:
    real = doctor.installed_version

    def without_torch(name: str) -> str | None:
        if name in ("torch", "pymunk"):
            return None
        return "1.0" if name in ("stable-baselines3", "sb3-contrib", "tensorboard") else real(name)

    monkeypatch.setattr(doctor, "installed_version", without_torch)
    sections = json.loads(report("--json"))
    assert sections["Learning"]["torch"]["value"] == "missing"
    assert sections["Learning"]["tensorboard"]["value"] == "1.0"
    assert install_command("learn") in sections["Learning"]["in all"]["meaning"]
    assert sections["Packages"]["pymunk"] == {"value": "missing", "meaning": "Install the kit again."}


def test_with_the_whole_extra_nothing_is_said_to_be_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor, "installed_version", lambda name: "1.0")
    learning = json.loads(report("--json"))["Learning"]
    assert {entry["value"] for entry in learning.values()} == {"1.0"}


def test_every_level_of_confinement_is_reported_with_its_reason() -> None:
    levels = json.loads(report("--json"))["Student code"]
    assert list(levels) == [f"level {number}" for number in range(4)]
    assert levels["level 0"]["value"] == "available"
    for entry in levels.values():
        assert entry["value"] in ("available", "not available")
        assert entry["meaning"].endswith(".")
        assert not entry["meaning"].endswith("..")


@pytest.mark.long_cases("missing")
@pytest.mark.parametrize("state", ["missing", "there", "a file"])
def test_the_workspace(tmp_path: Path, state: str) -> None:
    folder = tmp_path / "own"
    if state == "there":
        folder.mkdir()
    elif state == "a file":
        folder.write_text("")
    entry = json.loads(report("--json", KIT_WORKSPACE=str(folder)))["Your files"]["workspace"]
    assert entry["value"] == str(folder)
    says = {"missing": "first start creates it", "there": "Ready", "a file": "--workspace"}
    assert says[state] in entry["meaning"]
    assert folder.exists() == (state != "missing")


@pytest.mark.long
@pytest.mark.parametrize(
    ("answer", "value"),
    [
        (b"\x1b[?27u\x1b[?62;c", "reported"),
        (b"\x1b[?62;c", "not reported"),
        (b"\x1b[?25u\x1b[?62;c", "not reported"),
    ],
)
def test_on_a_terminal_it_asks_for_key_releases(answer: bytes, value: str) -> None:
    enter = "import fcntl, termios; fcntl.ioctl(0, termios.TIOCSCTTY, 0)"  # as a login does
    code = f"{enter}; from kit.cli import main; main(['doctor', '--json'])"
    ours, theirs = pty.openpty()
    with subprocess.Popen(
        [sys.executable, "-c", code],
        stdin=theirs,
        stdout=subprocess.PIPE,
        stderr=theirs,
        env={**os.environ, "TERM": "xterm-256color"},
        start_new_session=True,
    ) as child:
        try:
            assert select.select([ours], [], [], 20)[0]
            assert os.read(ours, 1000).endswith(b"\x1b[c")
            os.write(ours, answer)
            output, _ = child.communicate(timeout=20)
        finally:
            child.kill()
            os.close(ours)
            os.close(theirs)
    terminal = json.loads(output)["Terminal"]
    assert (
        terminal["screen"]["value"] == "full screen"
    )  # although this output is no terminal: the kit's would be
    assert terminal["key release"]["value"] == value


@pytest.mark.long
def test_it_loads_nothing_heavy() -> None:
    code = "import sys; from kit.cli.doctor import findings; findings(); print(*sys.modules)"
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, stdin=subprocess.DEVNULL
    )
    assert {"textual", "torch", "numba", "numpy", "pymunk", "gymnasium"}.isdisjoint(run.stdout.split())


@pytest.fixture
def costs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(class_costs, "measure_costs", lambda: UseCost(0.16, 132e6, 1.8, 7.0, 119e6))
    monkeypatch.setattr(class_costs, "this_machine", lambda: MachineSize(8, 16e9))


@pytest.mark.usefixtures("costs")
def test_a_class_fits_or_does_not() -> None:
    fits = json.loads(report("--class", "30", "--json"))["A class of 30"]["this machine"]
    not_all = json.loads(report("--class", "300", "--json"))["A class of 300"]["this machine"]
    assert fits["value"] != not_all["value"]
    assert fits["meaning"] == not_all["meaning"]
    text = report("--class", "30")
    assert all(len(line) <= 80 for line in text.splitlines())
    assert "100,000 learners" in text


def test_a_machine_that_tells_nothing_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse() -> MachineSize:
        raise class_costs.NotMeasured("only Linux says")

    monkeypatch.setattr(class_costs, "this_machine", refuse)
    ended = CliRunner().invoke(command, ["--class", "30"])
    assert ended.exit_code == 2
    assert "only Linux says" in ended.output
