"""The schemas by which editors and services check workflow files and forms: those that ``check-jsonschema`` carries with it, from
SchemaStore (GitHub's) and from GitLab itself. Nothing is downloaded."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path


def why_invalid(schema: str, *files: Path) -> str:
    """What is wrong with the files by a schema such as ``github-workflows``; empty if nothing is."""
    transform = ("--data-transform", "gitlab-ci") if schema == "gitlab-ci" else ()  # its !reference
    command = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", f"vendor.{schema}", *transform]
    done = subprocess.run([*command, *map(str, files)], capture_output=True, text=True, check=False)
    return "" if done.returncode == 0 else done.stdout + done.stderr
