"""How the kit is installed here: its version and extras, the command that adds one, and who has written over its files."""

from __future__ import annotations

import base64
import hashlib
import os
import re
import shlex
import shutil
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from importlib.metadata import (
        Distribution,  # inside the functions: it takes longer than a light command may wait for
    )

DISTRIBUTION: Final = "robot-learning-kit"
TOP_LEVEL: Final = ("kit", "grader")
"""The packages of the distribution. Others on the package index carry the same names."""
_REQUIREMENT: Final = re.compile(r"""(?P<name>[\w.-]+)[^;]*(;.*extra == ['"](?P<extra>\w+)['"])?""")
_OLDER_THAN: Final = re.compile(r"""python_version < ['"]3\.(\d+)['"]""")
_PACKAGE: Final = Path(__file__).parent


def requirements(extra: str | None = None) -> tuple[str, ...]:
    """Names of the packages that the kit needs, or that one of its extras adds; none where the kit is not installed."""
    from importlib.metadata import PackageNotFoundError, requires

    try:
        lines = requires(DISTRIBUTION) or ()
    except PackageNotFoundError:
        return ()
    found = (match for line in lines if not _is_for_older(line) and (match := _REQUIREMENT.match(line)))
    return tuple(match["name"] for match in found if match["extra"] == extra)


def _is_for_older(requirement: str) -> bool:
    """Whether a requirement is for a Python older than this one."""
    bound = _OLDER_THAN.search(requirement)
    return bound is not None and sys.version_info[1] >= int(bound[1])


def installed_version(package: str) -> str | None:
    """The version of an installed package; None if it is missing. Does not import the package."""
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version(package)
    except PackageNotFoundError:
        return None


def constraints_file() -> Path:
    """The versions that the kit is tested with, and where torch's CPU build comes from: in the installed package, or beside it
    in a checkout."""
    shipped = _PACKAGE / "data" / "constraints.txt"
    return shipped if shipped.is_file() else _PACKAGE.parent / "constraints.txt"


def install_command(extra: str) -> str:
    """What to type on this machine to add an extra to this installation, in any folder."""
    packages = requirements(extra)
    python = shlex.quote(sys.executable)
    has_pip = _is_distribution_installed("pip")
    uv = shutil.which("uv")
    program = f"{python} -m pip install" if has_pip or uv is None else f"uv pip install --python {python}"
    pins = f"-c {shlex.quote(str(constraints_file()))}"
    if packages:
        return f"{program} {pins} {' '.join(packages)}"
    return f"{program} {pins} -e {shlex.quote(f'{_PACKAGE.parent}[{extra}]')}"


def foreign_distributions(*, only_named: bool = False) -> Iterator[tuple[str, str]]:
    """Yields name and version of each other distribution that has written over files of the kit.

    ``only_named``: looks only at distributions that are called as one of the packages is, which takes a millisecond.
    """
    if only_named and not any(_is_distribution_installed(name) for name in TOP_LEVEL):
        return
    from importlib.metadata import PackageNotFoundError, distribution, distributions

    try:
        own = distribution(DISTRIBUTION).files or ()
    except PackageNotFoundError:
        return
    own_hashes = {str(file): file.hash.value for file in own if file.hash is not None}
    for each in distributions():
        name = each.metadata["Name"]
        is_ours = not name or name.lower().replace("_", "-") == DISTRIBUTION
        if not is_ours and (not only_named or name in TOP_LEVEL) and _has_written_over(each, own_hashes):
            yield name, each.version


def _is_distribution_installed(name: str) -> bool:
    """Whether a folder of packages has the record of a distribution of this name."""
    for folder in sys.path:
        try:
            with os.scandir(folder or ".") as entries:
                if any(entry.name.lower().startswith(f"{name}-") for entry in entries):
                    return True
        except OSError:
            continue
    return False


def _has_written_over(distribution: Distribution, own_hashes: Mapping[str, str]) -> bool:
    """Whether one of the kit's files holds what another distribution says that it has installed there."""
    for file in distribution.files or ():
        own = own_hashes.get(str(file))
        if own is None or file.hash is None or file.hash.value == own:
            continue
        try:
            content = Path(str(file.locate())).read_bytes()
        except OSError:
            continue
        digest = hashlib.new(file.hash.mode, content).digest()
        if base64.urlsafe_b64encode(digest).rstrip(b"=").decode() == file.hash.value:
            return True
    return False


def overwritten_text(name: str, its_version: str) -> str:
    """One sentence about another distribution that uses the kit's folders, with the way out."""
    python = shlex.quote(sys.executable)
    return (
        f"Another package, {name} {its_version}, has written over files of the kit, for both have a folder of the same name. "
        f"Remove it, then install the kit again: {python} -m pip uninstall -y {name}; then the command with which you "
        "installed the kit, with --force-reinstall --no-deps added."
    )
