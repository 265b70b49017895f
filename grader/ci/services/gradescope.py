"""Gradescope: an archive with what it installs, what it runs, and the whole assignment."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Sequence
from pathlib import Path, PurePosixPath
from typing import Final

from grader.ci.ci_service import CiRunner, CiService, GitSource, GradedWork
from grader.reading import SECRET_FILE

SETUP: Final = """\
#!/usr/bin/env bash
# Made by `grader ci gradescope`. Installs the kit when Gradescope builds the autograder.
set -euo pipefail
apt-get update
apt-get install -y git python3.12 python3.12-venv || apt-get install -y git python3.11 python3.11-venv
python=$(command -v python3.12 || command -v python3.11)
git clone --quiet --depth 1 {clone} /opt/kit
"$python" -m venv /opt/grader
/opt/grader/bin/python -P -m pip install --quiet -c /opt/kit/constraints.txt /opt/kit
"""

RUN: Final = """\
#!/usr/bin/env bash
# Made by `grader ci gradescope`. Grades one submission, with the secret seeds of the assignment in this archive.
cd /autograder/source
/opt/grader/bin/python -P -m grader check /autograder/submission --assignment /autograder/source/assignment \\
  {secret}--level highest --format gradescope --output /autograder/results/results.json 2> /tmp/said.txt
if [ ! -s /autograder/results/results.json ]; then
  # What cannot be read earns nothing here, since Gradescope knows no blank; the student reads why and hands in again.
  /opt/grader/bin/python -P -c 'import json, sys
said = open("/tmp/said.txt", encoding="utf-8", errors="replace").read()[-4000:]
json.dump({{"score": 0, "output": said, "output_format": "text", "stdout_visibility": "hidden"}}, sys.stdout)' \\
    > /autograder/results/results.json
fi
"""


def write(works: Sequence[GradedWork], kit: GitSource, runner: CiRunner) -> bytes:
    """Makes autograder.zip for the first of the works, with the secrets of its assignment, which students never see there."""
    folder = Path(works[0].assignment)
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        secret = "--secret " if (folder / SECRET_FILE).exists() else ""
        for name, text in (
            ("setup.sh", SETUP.format(clone=kit.clone)),
            ("run_autograder", RUN.format(secret=secret)),
        ):
            _add_to_archive(archive, name, text.encode(), 0o755)
        for file in sorted(path for path in folder.rglob("*") if path.is_file()):
            inside = file.relative_to(folder)
            if not any(part.startswith((".", "__")) for part in inside.parts):
                _add_to_archive(archive, f"assignment/{inside.as_posix()}", file.read_bytes(), 0o644)
    return packed.getvalue()


def _add_to_archive(archive: zipfile.ZipFile, name: str, data: bytes, mode: int) -> None:
    entry = zipfile.ZipInfo(name)  # without a time: equal contents give equal bytes
    entry.compress_type = zipfile.ZIP_DEFLATED
    entry.external_attr = mode << 16
    archive.writestr(entry, data)


SERVICE: Final = CiService(
    "gradescope", PurePosixPath("autograder.zip"), write, is_in_students_repository=False, is_text=False
)
