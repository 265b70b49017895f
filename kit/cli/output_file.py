"""The path of a file to be written, as a type of a command's parameter."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from kit.cli.messages import describe_os_error
from kit.workspace import check_writable


class OutputFile(click.Path):
    """The path of a file that can be written, which is found out before the command's work and not at its end."""

    def __init__(self, *, allow_dash: bool = False) -> None:
        """``allow_dash``: whether - is standard output."""
        super().__init__(dir_okay=False, allow_dash=allow_dash, path_type=Path)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        path = Path(super().convert(value, param, ctx))  # type: ignore[arg-type]  # path_type is Path
        if not (self.allow_dash and str(path) == "-"):
            try:
                check_writable(path)
            except OSError as error:
                raise click.BadParameter(describe_os_error(error), ctx, param) from None
        return path
