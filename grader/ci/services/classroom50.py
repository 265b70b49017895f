"""Classroom 50: a script beside the assignment, which its runner starts in the student's checkout."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePosixPath
from typing import Final

from grader.ci.ci_service import CiRunner, CiService, GitSource, GradedWork

SCRIPT: Final = """\
#!/usr/bin/env python3
\"\"\"Made by `grader ci classroom50`: put it beside a copy of the assignment's folder, called `assignment`.

Classroom 50's runner starts it in the student's checkout and takes the result.json that it writes there.
\"\"\"

import subprocess
import sys
import tempfile
from pathlib import Path

HERE, CHECKOUT = Path(__file__).resolve().parent, Path.cwd()
RESULT = CHECKOUT / "result.json"
RESULT.unlink(missing_ok=True)  # what a student commits under this name is no result
with tempfile.TemporaryDirectory() as folder:
    # Nothing but the grader's sandbox starts in the student's folder, and -P keeps its modules out.
    subprocess.run("git clone --quiet --depth 1 {clone} kit".split(), cwd=folder, check=True)
    install = "-P -m pip install --quiet -c kit/constraints.txt ./kit".split()
    subprocess.run([sys.executable, *install], cwd=folder, check=True)
    check = ["-P", "-m", "grader", "check", str(CHECKOUT / "{work}"), "--assignment", str(HERE / "assignment")]
    check += ["--level", "highest", "--format", "classroom50", "--output", str(RESULT)]
    status = subprocess.run([sys.executable, *check], cwd=folder).returncode
sys.exit(0 if status in (0, 1) else status)  # a failing grade is no failure of the runner
"""


def write(works: Sequence[GradedWork], kit: GitSource, runner: CiRunner) -> bytes:
    """Makes the script, for the first of the works."""
    return SCRIPT.format(work=works[0].work, clone=kit.clone).encode()


SERVICE: Final = CiService(
    "classroom50", PurePosixPath("autograder.py"), write, is_in_students_repository=False
)
