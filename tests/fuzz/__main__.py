"""Fuzzes everything that reads what others write: ``python -m tests.fuzz`` tries 10,000 inputs of each kind, ``--seconds 600``
as many as it can.

Goes on where it was left when it is called again with the same ``--seed``. ``--replay frames:17`` tries one input again.
Exit code 1 if there are findings.
"""

from __future__ import annotations

import json
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import click

from kit.workspace import write_atomically
from tests.fuzz.run import TARGETS, BatchReport, input_rng, run_batch

BATCH = 1000


@click.command(help=__doc__)
@click.option(
    "--inputs",
    type=click.IntRange(1),
    default=10_000 * len(TARGETS),
    show_default=True,
    help="Of all targets together.",
)
@click.option(
    "--seconds", type=click.FloatRange(1), help="Go on until this time is over, instead of --inputs."
)
@click.option("--only", default=",".join(TARGETS), show_default=True, help="Targets, separated by commas.")
@click.option("--seed", default=1, show_default=True)
@click.option("--state", type=click.Path(path_type=Path), help="Where the state is kept, to go on from.")
@click.option("--again", is_flag=True, help="Begin anew.")
@click.option("--replay", metavar="TARGET:NUMBER", help="Try one input again, with its whole traceback.")
def main(
    *,
    inputs: int,
    seconds: float | None,
    only: str,
    seed: int,
    state: Path | None,
    again: bool,
    replay: str | None,
) -> None:
    names = only.split(",")
    unknown = sorted(set(names) - set(TARGETS))
    if unknown:
        raise click.UsageError(f"no target {', '.join(unknown)}: there are {', '.join(TARGETS)}")
    if replay is not None:
        _replay(replay, seed)
        return
    file = state or Path(tempfile.gettempdir()) / f"kit-fuzz-{seed}.json"
    if again:
        file.unlink(missing_ok=True)
    saved = json.loads(file.read_bytes()) if file.exists() else {}
    tried = {name: saved.get("tried", {}).get(name, 0) for name in TARGETS}
    findings = list(saved.get("findings", []))
    outcomes = {name: Counter(saved.get("outcomes", {}).get(name, {})) for name in TARGETS}
    growth = {name: saved.get("growth", {}).get(name, 0) for name in TARGETS}
    share = -(-inputs // len(names))
    until = None if seconds is None else time.monotonic() + seconds
    length = inputs if seconds is None else round(seconds)
    with click.progressbar(length=length, label="tried", file=sys.stderr) as bar:
        if seconds is None:
            bar.update(min(inputs, sum(tried[name] for name in names)))
        while True:
            name = min(names, key=tried.__getitem__)
            left = share - tried[name] if until is None else BATCH
            if left <= 0 or (until is not None and time.monotonic() >= until):
                break
            began = time.monotonic()
            report = run_batch(name, range(tried[name], tried[name] + min(BATCH, left)), seed=seed)
            tried[name] += report.done
            outcomes[name] += report.outcomes
            growth[name] = max(growth[name], report.growth)
            findings += _tell(report)
            write_atomically(file, _packed(tried, outcomes, growth, findings))
            bar.update(report.done if until is None else round(time.monotonic() - began))
    for name in names:
        click.echo(
            f"{name}: {tried[name]} inputs, memory grew by at most {growth[name] / 2**20:.1f} MiB in a batch"
        )
        for outcome, count in outcomes[name].most_common(8):
            click.echo(f"  {count:>8} {outcome}")
    click.echo(f"{sum(tried[name] for name in names)} inputs, {len(findings)} findings")
    for finding in findings:
        click.echo(finding)
    raise SystemExit(bool(findings))


def _tell(report: BatchReport) -> list[str]:
    lines = [str(each) for each in report.findings]
    for line in lines:
        click.echo(f"\n{line}", err=True)
    return lines


def _packed(
    tried: dict[str, int], outcomes: dict[str, Counter[str]], growth: dict[str, int], findings: list[str]
) -> bytes:
    state = {"tried": tried, "outcomes": outcomes, "growth": growth, "findings": findings}
    return json.dumps(state).encode()


def _replay(text: str, seed: int) -> None:
    name, _, number = text.partition(":")
    if name not in TARGETS or not number.isdigit():
        raise click.UsageError(f"{text!r} is not TARGET:NUMBER, such as frames:17")
    with tempfile.TemporaryDirectory() as folder:
        click.echo(TARGETS[name](Path(folder)).attempt(input_rng(seed, name, int(number))))


if __name__ == "__main__":
    main()
