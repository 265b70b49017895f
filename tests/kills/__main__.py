"""SIGKILLs drives, trainings, quizzes, cohorts and checks at random moments: ``python -m tests.kills --kills 200``.

After each kill comes the next start; then nothing that was confirmed may be lost, and no process, socket or folder may
be left. Exit code 1 if there are findings.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import click

from tests.kills.run import KillReport, run_kills
from tests.kills.scenarios import SCENARIOS


@click.command(help=__doc__)
@click.option(
    "--kills", type=click.IntRange(1), default=200, show_default=True, help="Of all scenarios together."
)
@click.option(
    "--only", default=",".join(SCENARIOS), show_default=True, help="Scenarios, separated by commas."
)
@click.option("--seed", default=1, show_default=True)
def main(*, kills: int, only: str, seed: int) -> None:
    names = only.split(",")
    unknown = sorted(set(names) - set(SCENARIOS))
    if unknown:
        raise click.UsageError(f"no scenario {', '.join(unknown)}: there are {', '.join(SCENARIOS)}")
    reports: dict[str, KillReport] = {}
    with (
        tempfile.TemporaryDirectory(prefix="kit-kills-") as folder,
        click.progressbar(length=kills, label="killed", file=sys.stderr) as bar,
    ):
        for number, name in enumerate(names):
            share = kills // len(names) + (number < kills % len(names))
            reports[name] = run_kills(
                name, share, Path(folder), seed=seed, on_kill=lambda report: bar.update(1)
            )
    findings = [finding for report in reports.values() for finding in report.findings]
    for name, report in reports.items():
        click.echo(f"{name}: {report.kills} kills, {report.in_time} before the end")
    click.echo(f"{sum(report.kills for report in reports.values())} kills, {len(findings)} findings")
    for finding in findings:
        click.echo(finding)
    raise SystemExit(bool(findings))


if __name__ == "__main__":
    main()
