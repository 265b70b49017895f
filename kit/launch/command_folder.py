"""The folder with the command ``ros2``, for programs and launch files that call it by a shell: it is ``kit ros``."""

from __future__ import annotations

import hashlib
import os
import shlex
import tempfile
from collections.abc import Mapping
from pathlib import Path

from kit.host.python_command import python_command


def with_commands(environment: Mapping[str, str]) -> dict[str, str]:
    """Returns an environment in whose PATH ``ros2`` is found first; the same one where no file can be written for it."""
    try:
        folder = _command_folder()
    except OSError:
        return dict(environment)
    rest = environment.get("PATH", os.defpath)
    return {**environment, "PATH": f"{folder}{os.pathsep}{rest}"}


def _command_folder() -> Path:
    """Makes the folder if it is not there yet. Raises OSError."""
    imported = os.pathsep.join(filter(None, (str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH"))))
    text = (
        "#!/bin/sh\n"
        f'PYTHONPATH={shlex.quote(imported)} exec {shlex.join(python_command("kit", "ros"))} "$@"\n'
    )
    mark = hashlib.sha256(text.encode()).hexdigest()[:12]
    folder = Path(tempfile.gettempdir()) / f"kit-commands-{os.getuid()}-{mark}"
    file = folder / "ros2"
    folder.mkdir(0o700, exist_ok=True)
    if folder.stat().st_uid != os.getuid():
        raise PermissionError(f"{folder} belongs to somebody else")
    if not file.is_file():
        handle, made = tempfile.mkstemp(dir=folder)
        with os.fdopen(handle, "w", encoding="utf-8") as opened:
            opened.write(text)
        Path(made).chmod(0o700)
        Path(made).replace(file)
    return folder
