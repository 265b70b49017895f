"""The example package, installed as pip does it but in a folder of its own, and packages that are broken."""

from __future__ import annotations

import os
import shutil
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from kit.extensions import PREFIX

EXAMPLE: Final = Path(__file__).parent / "example_package"
ROOT: Final = Path(__file__).parents[2]


def write_distribution(
    site: Path, name: str, version: str, parts: Mapping[str, Mapping[str, str]], modules: Mapping[str, str]
) -> None:
    """Writes modules, and the record by which they are found. ``parts``: by group, name and value."""
    for module, text in modules.items():
        (site / f"{module}.py").write_text(text)
    info = site / f"{name.replace('-', '_')}-{version}.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n")
    lines = (
        f"[{PREFIX}{group}]\n" + "".join(f"{part} = {value}\n" for part, value in entries.items())
        for group, entries in parts.items()
    )
    (info / "entry_points.txt").write_text("\n".join(lines))


def install_example(site: Path) -> None:
    """Installs the example package into a folder."""
    project = tomllib.loads((EXAMPLE / "pyproject.toml").read_text())["project"]
    parts = {group.removeprefix(PREFIX): entries for group, entries in project["entry-points"].items()}
    shutil.copytree(
        EXAMPLE / "example_parts", site / "example_parts", ignore=shutil.ignore_patterns("__pycache__")
    )
    write_distribution(site, project["name"], project["version"], parts, {})


def environment(site: Path, workspace: Path) -> dict[str, str]:
    """The environment of a program that sees what is installed there."""
    return {**os.environ, "PYTHONPATH": f"{ROOT}{os.pathsep}{site}", "KIT_WORKSPACE": str(workspace)}
