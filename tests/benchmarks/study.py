"""Makes the recorded results that come with the kit, and its document: ``python tests/benchmarks/study.py TABLE ...``.

A table is its number, such as 5.2, or 5.2-kit for the kit's own preset, 4.1-no-limit, or figure-3.5; without one, only the document is written anew
from the logs that are there. ``--seeds N``, ``--steps N`` and ``--jobs N`` are passed on to ``kit study TABLE --again``.
Results are made in ``--workspace`` (by default ``~/.cache/kit-study``) by the command itself and copied to
``kit/study/results``: interrupt it as you like, the same line goes on. README's section is written anew, too.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from kit.study.result_logs import SHIPPED_FOLDER, recorded_result_file
from kit.study.study_check import README
from kit.study.study_document import DOCUMENT, recorded_study_document
from kit.study.study_summary import summary_lines
from kit.study.study_variants import VARIANT_OPTIONS, VARIANTS, StudyVariant
from kit.workspace import Workspace

HEADING = "## The dissertation, reproduced\n"
"""Of the section of README that follows from the logs."""


def make(table: str, workspace: Path, options: list[str]) -> bool:
    """Runs ``kit study TABLE --again`` and copies its log. Returns whether it ended well."""
    variant: StudyVariant = next((each for each in VARIANTS if table.endswith(f"-{each}")), "seed")
    number = table.removesuffix(f"-{variant}")
    words = ["study", *number.split("-"), "--again", *VARIANT_OPTIONS[variant].split(), *options]
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
    text = README.read_text(encoding="utf-8")
    first = text.index(HEADING) + len(HEADING)
    last = text.index("\n## ", first)
    README.write_text("\n".join((text[:first], *summary_lines(), text[last:])), encoding="utf-8")
    if failed:
        print(f"not whole: {', '.join(failed)}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
