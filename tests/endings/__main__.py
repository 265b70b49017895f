"""Ends thirteen recorders in every way, and prints what was kept: ``python -m tests.endings``.

``--only "run --bag,quiz"`` and ``--endings SIGTERM,SIGKILL`` choose. Exit code 1 if anything was lost or ended in a
traceback, or if a program that could write nothing said nothing. "full disk" and "read only" need the right to mount.
"""

from __future__ import annotations

import signal
import tempfile
from pathlib import Path

import click

from tests.endings.endings import ENDINGS, NEED_MOUNT, Ending, can_mount, try_ending
from tests.endings.recorders import RECORDERS


@click.command(help=__doc__)
@click.option("--only", default=",".join(RECORDERS), help="Recorders, separated by commas.")
@click.option("--endings", default=",".join(ENDINGS), help="Endings, separated by commas.")
@click.option("-v", "--verbose", is_flag=True, help="Print exit codes and last lines.")
def main(*, only: str, endings: str, verbose: bool) -> None:
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background job ignores both,
    signal.signal(signal.SIGQUIT, signal.SIG_DFL)  # as would what it starts
    names = [name for name in endings.split(",") if name not in NEED_MOUNT or can_mount()]
    click.echo(f"{'':<18}" + "".join(f"{name:>11}" for name in names))
    lost: list[str] = []
    with tempfile.TemporaryDirectory(prefix="kit-endings-") as folder:
        for recorder in only.split(","):
            click.echo(f"{recorder:<18}", nl=False)
            told = []
            for name in names:
                try:
                    ending = try_ending(recorder, name, Path(folder))
                except AssertionError as error:
                    ending = Ending(0, 0, str(error))
                mark = "T" if ending.has_traceback else ""
                click.echo(f"{f'{ending.kept}{mark}':>11}", nl=False)
                told.append(f"    {name}: exit {ending.exit_code}: {ending.text}")
                if not ending.is_right:
                    lost.append(f"{recorder}, {name}: exit {ending.exit_code}: {ending.text}")
            click.echo()
            if verbose:
                click.echo("\n".join(told))
    for each in lost:
        click.echo(each)
    click.echo(f"{len(lost)} not right")
    raise SystemExit(bool(lost))


if __name__ == "__main__":
    main()
