"""What other terminals cost a running world: ticks per second of the maze as fast as it goes, without a server, with
one, and with clients that do nothing, echo the scan, and record everything. Run it on a quiet machine."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from kit.inspection.server import InspectionServer
from kit.inspection.sockets import sockets_folder
from kit.run.runner import Runner
from kit.run.scenario import find_scenario
from kit.run.session import Session

SECONDS, REPEATS = 1.0, 5

CASES: tuple[tuple[str, bool, tuple[tuple[str, ...], ...]], ...] = (
    ("no server", False, ()),
    ("a server", True, ()),
    ("a visitor that waits", True, (("topic", "hz", "/nothing"),)),
    ("one that echoes the scan", True, (("topic", "echo", "/static_laser"),)),
    ("one that records everything", True, (("bag", "record", "-a", "-o", "bag"),)),
)


def measure(has_server: bool, clients: Sequence[Sequence[str]]) -> float:
    """Ticks per second, the best of several stretches."""
    with tempfile.TemporaryDirectory() as folder, Session(find_scenario("maze"), always_scan=True) as session:
        runner = session.runner
        processes = []
        if has_server:
            server = InspectionServer(session.graph, sockets_folder(Path(folder)), "maze")
            runner.participants.append(server)
            for words in clients:
                command = [sys.executable, "-m", "kit", "ros", *words]
                environment = {**os.environ, "KIT_WORKSPACE": folder}
                processes.append(
                    subprocess.Popen(
                        command,
                        cwd=folder,
                        env=environment,
                        stdout=subprocess.DEVNULL,
                        stderr=subprocess.DEVNULL,
                    )
                )
            until = time.monotonic() + 4.0 * bool(clients)
            while time.monotonic() < until:
                runner.tick()
                time.sleep(0.005)
            assert server.client_count == len(clients)
        rate = max(_rate(runner) for _ in range(REPEATS))
        for process in processes:
            process.kill()
            process.wait()
        if has_server:
            server.close()
        return rate


def _rate(runner: Runner) -> float:
    ticks, began = 0, time.perf_counter()
    while time.perf_counter() - began < SECONDS:
        runner.tick()
        ticks += 1
    return ticks / (time.perf_counter() - began)


def main() -> None:
    bare = 0.0
    for name, has_server, clients in CASES:
        rate = measure(has_server, clients)
        bare = bare or rate
        print(f"{name:<30} {rate:>8.0f} ticks/s  {rate / bare:>5.0%}")


if __name__ == "__main__":
    main()
