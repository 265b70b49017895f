"""The commit of the kit's own source, asked of git without running what a repository names."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

from kit.study.result_logs import (
    SHIPPED_FOLDER,
)


def kit_commit() -> str:
    """The commit of the kit's source, with a plus sign where files differ from it; empty where there is no repository.

    Recorded results, which recording itself changes, do not count.
    """
    results = f":!{SHIPPED_FOLDER.relative_to(Path(__file__).parents[2])}"
    try:
        commit = _run_git("describe", "--always", "--abbrev=12", "--exclude=*")
        return commit + ("+" if _run_git("status", "--porcelain", "-uno", "--", "kit", results) else "")
    except (OSError, subprocess.SubprocessError):
        return ""


def _run_git(*words: str) -> str:
    """Asks the repository that the folder of the kit's source is, and has git run none of the programs that it names.

    A repository above an installed kit, or one that the user's variables name, may be anybody's.
    """
    folder = Path(__file__).resolve().parents[2]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    environment |= {"GIT_CEILING_DIRECTORIES": str(folder.parent), "GIT_OPTIONAL_LOCKS": "0"}

    def run(*command: str, check: bool) -> str:
        found = subprocess.run(
            ["git", "-c", "core.fsmonitor=false", "-c", "core.hooksPath=/dev/null", *command],
            cwd=folder,
            env=environment,
            capture_output=True,
            text=True,
            timeout=20,
            check=check,
        )
        return found.stdout.strip()

    filters = run("config", "--name-only", "--get-regexp", r"^filter\..*\.(clean|process)$", check=False)
    names = filters.splitlines()
    environment["GIT_CONFIG_COUNT"] = str(len(names))
    for number, name in enumerate(names):  # -c would end a name at its first equals sign
        environment |= {f"GIT_CONFIG_KEY_{number}": name, f"GIT_CONFIG_VALUE_{number}": ""}
    return run(*words, check=True)
