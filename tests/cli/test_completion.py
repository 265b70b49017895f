"""Completion: the scripts, and what the programs answer a shell."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from kit.cli import VERBS
from kit.cli.completion import SHELLS
from tests.cli.verbs import kit


def answers(program: str, *words: str) -> list[str]:
    """What a program answers bash that completes the last of these words."""
    asked = {
        f"_{program.upper()}_COMPLETE": "bash_complete",
        "COMP_WORDS": " ".join((program, *words)),
        "COMP_CWORD": str(len(words)),
    }
    module = {"kit": "kit.cli", "grader": "grader.__main__"}[program]
    ended = subprocess.run(
        [sys.executable, "-c", f"from {module} import run; run()"],
        env={**os.environ, **asked},
        capture_output=True,
        text=True,
        check=True,
    )
    return [line.partition(",")[2] for line in ended.stdout.splitlines()]


def test_commands_and_options_are_completed() -> None:
    assert answers("kit", "ru") == ["run", "runs"]
    assert answers("kit", "run", "--ste") == ["--steps"]
    assert answers("kit", "ros", "topic", "e") == ["echo"]
    assert answers("grader", "self") == ["self-test"]


def test_a_word_that_may_be_a_file_is_left_to_the_shell() -> None:
    """A shell that is told nothing completes nothing, not even files."""
    assert answers("kit", "world", "check", "worl") == ["worl"]
    assert answers("kit", "lesson", "--from", "fol") == ["fol"]
    assert not any(answers("kit", "nonsense"))


def test_completing_a_command_imports_none() -> None:
    program = (
        "import sys; from kit.cli import main\nmain.shell_complete(__import__('click').Context(main), '')\n"
    )
    program += "print(*sys.modules)"
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    modules = {module.partition(":")[0] for module, _ in VERBS.values()}
    assert modules.isdisjoint(ended.stdout.split())


@pytest.mark.parametrize("shell", SHELLS)
def test_a_script_serves_both_programs(shell: str) -> None:
    script = kit("completion", shell).output
    assert "_KIT_COMPLETE" in script
    assert "_GRADER_COMPLETE" in script
    if shutil.which(shell):
        subprocess.run([shell, "-n", "/dev/stdin"], input=script, text=True, check=True)


ASKED = {
    "bash": 'COMP_WORDS=(grader coh); COMP_CWORD=1; _grader_completion grader; echo "${COMPREPLY[@]}"',
    "zsh": "print ${_comps[grader]}",  # its completion runs within its line editor alone
    "fish": "complete --do-complete 'grader coh'",
}
"""What a new account's shell is asked after it has read the script, about the second program."""
ANSWERS = {"bash": "cohort", "zsh": "_grader_completion", "fish": "cohort"}


@pytest.mark.parametrize("shell", SHELLS)
def test_a_shell_without_settings_completes_with_it(shell: str, tmp_path: Path) -> None:
    if shutil.which(shell) is None:
        pytest.skip(f"no {shell}")
    programs = tmp_path / "bin"
    programs.mkdir()
    (programs / "grader").write_text(
        f'#!/bin/sh\nexec {sys.executable} -c "from grader.__main__ import run; run()" "$@"\n'
    )
    (programs / "grader").chmod(0o755)
    (tmp_path / "completion").write_text(kit("completion", shell).output)
    ended = subprocess.run(
        [shell, "-c", f"source {tmp_path}/completion; {ASKED[shell]}"],
        env={
            **os.environ,
            "HOME": str(tmp_path),
            "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
        },
        capture_output=True,
        text=True,
        check=True,
    )
    assert ended.stdout.split()[0] == ANSWERS[shell]
