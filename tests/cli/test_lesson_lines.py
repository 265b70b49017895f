"""A lesson by lines that come all at once, as a screen reader or a script sends them, and through a drive."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from kit.school.progress import Kind, Progress

LINES = "g 4\nd\ndrive 0.3 0 2\nquit\ng 3\nq\n"


def test_lines_that_come_at_once_are_all_heeded(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "kit", "lesson", "1", "--plain", "--workspace", str(tmp_path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as lesson:
        assert lesson.stdin is not None
        lesson.stdin.write(LINES)
        lesson.stdin.flush()  # and it stays open: nothing but the lines themselves says that there is more
        try:
            assert lesson.wait(timeout=120) == 0
        finally:
            lesson.kill()
        assert lesson.stdout is not None
        said = lesson.stdout.read()
    assert "does nothing here" not in said
    assert said.rindex("Step 3 of") > said.index("Checking")
    with Progress(tmp_path) as progress:
        (attempt,) = progress.events(Kind.ATTEMPT)
    assert attempt.content["points"] > 0
