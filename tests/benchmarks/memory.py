"""What the memory of a student's `kit drive` consists of: by package that is imported, and what a running drive adds.

`python tests/benchmarks/memory.py` opens `kit drive maze` in a terminal and presses keys; every import is measured as it
happens. A package's figure is what its own modules add to the process's resident memory, without what they import in turn.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from kit.school import class_costs

MEASURED = """
import importlib.machinery as machinery, json, os, signal, sys
from collections import Counter

added, stack = Counter(), []

def resident():
    with open("/proc/self/smaps_rollup") as file:
        return sum(int(line.split()[1]) for line in file if line.startswith("Rss:"))

def measured(load):
    def exec_module(self, module):
        before = resident()
        stack.append(0)
        try:
            return load(self, module)
        finally:
            grown = resident() - before
            added[module.__name__.partition(".")[0]] += grown - stack.pop()
            if stack:
                stack[-1] += grown
    return exec_module

for loader in (machinery.SourceFileLoader, machinery.ExtensionFileLoader):
    loader.exec_module = measured(loader.exec_module)
begin = resident()

def tell(*_):
    with open(OUTPUT + ".part", "w") as file:
        json.dump({"begin": begin, "added": added, "now": resident()}, file)
    os.replace(OUTPUT + ".part", OUTPUT)

signal.signal(signal.SIGUSR1, tell)
sys.argv = ["kit", *ARGUMENTS]
from kit.cli import run
run()
"""
SHOWN = 14
SETTLED_S = 3.0
MOST_S = 120.0


def measure(*arguments: str) -> dict[str, Any]:
    """KiB at the begin of a `kit` command in a terminal, by package, and in all, once keys have steered it."""
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "memory.json"
        program = f"OUTPUT = {str(output)!r}\nARGUMENTS = {[*arguments, '--workspace', folder]!r}\n{MEASURED}"
        with class_costs.in_terminal([sys.executable, "-P", "-c", program]) as (process, terminal):
            written = {terminal: 0}
            class_costs.wait_for_picture(written, [process])
            class_costs.press_keys(written, class_costs.DRIVE_S)
            before, content = {}, _told(process, written, output)
            while content["added"] != before:  # a slow machine still imports
                before, content = content["added"], _told(process, written, output)
            others = [each for each in class_costs._processes_of({process.pid}) if each != process.pid]
            content["others"] = {each: class_costs._memory(each) / 1024 for each in others}
            return content


def _told(process: subprocess.Popen[bytes], written: dict[int, int], output: Path) -> dict[str, Any]:
    """What the process says of itself, after some more keys. Raises TimeoutError."""
    output.unlink(missing_ok=True)
    os.kill(process.pid, signal.SIGUSR1)
    deadline = time.monotonic() + MOST_S
    while time.monotonic() < deadline:
        class_costs.press_keys(written, SETTLED_S)
        if output.exists():
            content: dict[str, Any] = json.loads(output.read_text())
            return content
    raise TimeoutError("the drive does not answer")


def main() -> None:
    found = measure("drive", *(sys.argv[1:] or ["maze"]))
    added = sorted(found["added"].items(), key=lambda each: -each[1])
    rows = [("Python itself", found["begin"]), *added[:SHOWN]]
    rows.append((f"{len(added) - SHOWN} other packages", sum(size for _, size in added[SHOWN:])))
    rows.append(
        ("the drive: objects and compiled code", found["now"] - found["begin"] - sum(found["added"].values()))
    )
    for name, size in rows:
        print(f"{size / 1024:7.1f} MiB  {100 * size / found['now']:4.1f} %  {name}")
    print(f"{found['now'] / 1024:7.1f} MiB  the kit's own process, resident")
    for size in found["others"].values():
        print(f"{size / 1024:7.1f} MiB  a program that it has started")


if __name__ == "__main__":
    main()
