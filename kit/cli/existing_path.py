"""The path of a file or a folder that must be there, as a type of a command's parameter."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import click

from kit.plain_files import nearest_file


class ExistingPath(click.Path):
    """The path of a file or a folder that is there; for another one, the name that is near is told."""

    def __init__(self, *, file_okay: bool = True, dir_okay: bool = True, path_type: type = Path) -> None:
        super().__init__(exists=True, file_okay=file_okay, dir_okay=dir_okay, path_type=path_type)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        try:
            return super().convert(value, param, ctx)
        except click.BadParameter as problem:
            near = nearest_file(Path(os.fspath(value)), is_folder=not self.file_okay)
            if not near or Path(value).exists():
                raise
            raise click.BadParameter(f"{problem.message} Did you mean {near}?", ctx, param) from None
