"""Makes the recorded results that come with the kit, and its document: ``python tests/benchmarks/study.py TABLE ...``.

A table is its number, such as 5.2, or 5.2-kit for the kit's own preset, or figure-3.5; without one, only the document is written anew
from the logs that are there. ``--seeds N``, ``--steps N`` and ``--jobs N`` are passed on to ``kit study TABLE --again``.
Results are made in ``--workspace`` (by default ``~/.cache/kit-study``) by the command itself and copied to
``kit/study/results``: interrupt it as you like, the same line goes on. The lines of README's table are printed last.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from kit.study.recorded_results import SHIPPED_FOLDER, StudyVariant, recorded_result_file
from kit.study.study_document import DOCUMENT, recorded_study_document, summary_lines
from kit.workspace import Workspace


def make(table: str, workspace: Path, options: list[str]) -> bool:
    """Runs ``kit study TABLE --again`` and copies its log. Returns whether it ended well."""
    number = table.removesuffix("-kit")
    variant: StudyVariant = "seed" if number == table else "kit"
    words = ["study", *number.split("-"), "--again", *(["--kit"] if variant == "kit" else []), *options]
    command = [sys.executable, "-m", "kit", *words, "--workspace", str(workspace)]
    ended = subprocess.run(command, stdout=subprocess.DEVNULL, check=False).returncode
    log = recorded_result_file(Workspace(workspace), number, variant)
    if log.exists():
        SHIPPED_FOLDER.mkdir(exist_ok=True)
        shutil.copyfile(log, SHIPPED_FOLDER / log.name)
    return ended == 0


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("tables", nargs="*", metavar="TABLE")
    parser.add_argument("--workspace", type=Path, default=Path.home() / ".cache" / "kit-study")
    for name in ("seeds", "steps", "jobs"):
        parser.add_argument(f"--{name}", type=int)
    given = parser.parse_args(arguments)
    options = [
        word
        for name in ("seeds", "steps", "jobs")
        if (value := getattr(given, name)) is not None
        for word in (f"--{name}", str(value))
    ]
    failed = [table for table in given.tables if not make(table, given.workspace, options)]
    DOCUMENT.write_text(recorded_study_document(), encoding="utf-8")
    print("\n".join(summary_lines()))
    if failed:
        print(f"not whole: {', '.join(failed)}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
