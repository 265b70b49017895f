"""Two builds against each other: ``python tests/benchmarks/paired.py OLD`` for the folder of another build.

Every benchmark of this folder that both builds have runs several times in each, old and new in turn. Of each figure the
median of the new build's price over the old one's is printed: above 1 the new one is dearer. What is more than a tenth
dearer is marked, and the command then fails. Benchmarks run shorter than alone.

What has run is kept in a file: the same command goes on where it was interrupted.
"""

from __future__ import annotations

import argparse
import ast
import json
import os
import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from typing import NamedTuple

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]

FEWER_CASES = "[type(each)(**{**vars(each), 'count': max(1, each.count // 10)}) for each in KINDS]"
SHORT = {
    "REPEATS": 3,
    "SECONDS": 0.1,
    "STARTS": 2,
    "FRAMES": 100,
    "TICKS": 500,
    "SCANS": 500,
    "KINDS": FEWER_CASES,
}
"""Constants of benchmarks, and what they are here."""
ARGUMENTS = {"grading": ["8", "2"]}
TOO_LONG = ("learning",)
"""Runs only if named: it trains for minutes."""
DEARER = 1.1
"""A figure that is more than so many times the old one's is marked."""

NUMBER = r"(?<![\w.,])(\d[\d,]*(?:\.\d+)?)"
HIGHER_IS_BETTER = ("steps/s", "ticks/s", "times real time")
LOWER_IS_BETTER = ("ms", "us", "s", "KB/s", "% of a core")
UNITS = "|".join(map(re.escape, HIGHER_IS_BETTER + LOWER_IS_BETTER))
WITH_UNIT = re.compile(rf"{NUMBER}\s?({UNITS})(?![\w/])")
NAMED_UNIT = re.compile(rf"^(.*(?:\[(1/s|ms|us|s|MiB)\]|per second).*?)\s{{2,}}{NUMBER}(?:\s|$)")
"""A line whose label says the unit, such as ``maze tick [us]   64.8``."""


class Figure(NamedTuple):
    """One figure of a benchmark's output."""

    label: str
    """The line without its figures, and the figure's place in it."""
    price: float
    """The higher, the worse: a time, or one over a rate."""


def figures(output: str) -> Iterator[Figure]:
    """The figures of an output with a unit that says which way is better."""
    for line in output.splitlines():
        if named := NAMED_UNIT.match(line):
            label, unit, number = named.groups()
            yield from _figure(label, number, is_rate=unit in (None, "1/s"))
            continue
        found = list(WITH_UNIT.finditer(line))
        for place, each in enumerate(found):
            label = WITH_UNIT.sub("#", line[: found[-1].end()]) + (
                f" ({place + 1})" if len(found) > 1 else ""
            )
            yield from _figure(label, each[1], is_rate=each[2] in HIGHER_IS_BETTER)


def _figure(label: str, number: str, *, is_rate: bool) -> Iterator[Figure]:
    value = float(number.replace(",", ""))
    if value > 0.0:
        yield Figure(" ".join(label.split()), 1.0 / value if is_rate else value)


def run_benchmark(file: Path, arguments: list[str]) -> None:
    """Runs a benchmark in this process as if it were the command, with SHORT constants."""
    sys.argv, sys.path[0] = [str(file), *arguments], str(file.parent)
    module = ast.parse(file.read_text())
    assigned = {
        name.id
        for node in module.body
        if isinstance(node, ast.Assign)
        for target in node.targets
        for name in ast.walk(target)
        if isinstance(name, ast.Name)
    }
    shorter = ast.parse("\n".join(f"{name} = {value}" for name, value in SHORT.items() if name in assigned))
    module.body[-1:-1] = shorter.body  # before it calls main
    exec(compile(module, file, "exec"), {"__name__": "__main__", "__file__": str(file)})


def output_of(root: Path, name: str) -> str:
    """What a benchmark prints in a build of its own process."""
    file = root / "tests" / "benchmarks" / f"{name}.py"
    command = [sys.executable, str(Path(__file__).resolve()), "--run", str(file), *ARGUMENTS.get(name, [])]
    environment = {**os.environ, "PYTHONPATH": str(root)}
    done = subprocess.run(command, env=environment, cwd=root, capture_output=True, text=True)
    if not done.stdout.strip() or "Traceback" in done.stderr:  # some say by their status that a figure is bad
        raise SystemExit(f"{file} has failed:\n{done.stderr}")
    return done.stdout


def common_benchmarks(old: Path) -> list[str]:
    """The names of the benchmarks that both builds have."""
    names = {file.stem for file in (old / "tests" / "benchmarks").glob("*.py")}
    return sorted(file.stem for file in HERE.glob("*.py") if file.stem in names)


def measure(old: Path, names: list[str], rounds: int, results: Path) -> dict[str, list[tuple[str, str]]]:
    """The outputs of old and new of every round, by benchmark; runs what ``results`` does not hold yet."""
    outputs: dict[str, list[tuple[str, str]]] = defaultdict(list)
    for line in results.read_text().splitlines() if results.exists() else ():
        kept = json.loads(line)
        outputs[kept["benchmark"]].append((kept["old"], kept["new"]))
    for number in range(rounds):
        for name in names:
            if len(outputs[name]) > number:
                continue
            print(f"round {number + 1} of {rounds}: {name}", file=sys.stderr, flush=True)
            found = {root: output_of(root, name) for root in ((old, ROOT) if number % 2 else (ROOT, old))}
            outputs[name].append((found[old], found[ROOT]))
            with results.open("a") as stream:
                record = {"benchmark": name, "old": found[old], "new": found[ROOT]}
                print(json.dumps(record), file=stream)
    return outputs


def ratios(pairs: list[tuple[str, str]]) -> dict[str, list[float]]:
    """The new price over the old one of each figure, round by round."""
    found: dict[str, list[float]] = defaultdict(list)
    for old, new in pairs:
        before = dict(figures(old))
        for label, price in figures(new):
            if label in before:
                found[label].append(price / before[label])
    return found


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("old", type=Path, metavar="OLD", help="The folder of the other build.")
    parser.add_argument("--only", nargs="+", metavar="BENCHMARK", help="These benchmarks.")
    parser.add_argument("--rounds", type=int, default=10, help="Runs of each build (10).")
    parser.add_argument("--results", type=Path, default=Path("paired.jsonl"), help="Where outputs are kept.")
    wanted = parser.parse_args()
    old, names = wanted.old.resolve(), common_benchmarks(wanted.old.resolve())
    if unknown := set(wanted.only or ()) - set(names):
        parser.error(f"both builds do not have {', '.join(unknown)}; they have {', '.join(names)}")
    names = wanted.only or [name for name in names if name not in TOO_LONG]
    outputs = measure(old, names, wanted.rounds, wanted.results)
    print("price of the new build over the old one's: median, least and most\n")
    dearer = 0
    for name in names:
        for label, each in ratios(outputs[name]).items():
            is_dearer = median(each) > DEARER
            dearer += is_dearer
            mark = "  more than 10 % slower" if is_dearer else ""
            print(f"{name:15} {median(each):5.2f} ({min(each):.2f} to {max(each):.2f})  {label}{mark}")
    print(f"\n{dearer} figures are more than 10 % slower")
    raise SystemExit(bool(dearer))


if __name__ == "__main__":
    if sys.argv[1:2] == ["--run"]:
        run_benchmark(Path(sys.argv[2]), sys.argv[3:])
    else:
        main()
