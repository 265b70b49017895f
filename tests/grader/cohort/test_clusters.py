"""A class is graded on real clusters whose workers are killed: a SLURM of one node, and a Dask scheduler with workers."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping
from importlib.util import find_spec
from pathlib import Path

import pytest

from grader.cohort.queue import Queue
from tests.grader.conftest import FORWARD, QUICK, write_assignment
from tests.host.one_node_slurm import PARTITION, one_node_cluster, why_impossible
from tests.waiting import wait_until

WORKS = 16
SLOW = QUICK.replace("time: 4", "time: 60")
"""Long enough for a worker to be killed in the midst of its works."""
LIMIT_S = 600.0

pytestmark = [pytest.mark.long, pytest.mark.nightly, pytest.mark.timeout(3 * LIMIT_S)]


@pytest.fixture
def handed_in(tmp_path: Path) -> Path:
    """A class whose programs all differ, and its assignment beside it."""
    write_assignment(tmp_path / "task", SLOW)
    for number in range(WORKS):
        work = tmp_path / "in" / f"student{number:02}" / "controller.py"
        work.parent.mkdir(parents=True)
        work.write_text(FORWARD.replace("SPEED = 0.3", f"SPEED = {0.1 + 0.01 * number:.2f}"))
    return tmp_path


def grade(folder: Path, environment: Mapping[str, str], *how: str) -> subprocess.Popen[str]:
    words = ["cohort", "in", "--assignment", "task", "--queue", "queue", *how]
    return subprocess.Popen(
        [sys.executable, "-m", "grader", *words],
        cwd=folder,
        env={**environment, "PYTHONPATH": str(Path(__file__).parents[3])},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def graded(folder: Path) -> int:
    return len(list((folder / "queue" / "results").glob("*.json")))


def processes(*words: str) -> list[int]:
    """Those whose command has all these words."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            command = (process / "cmdline").read_bytes().decode(errors="replace")
        except OSError:  # it has ended
            continue
        if all(word in command for word in words):
            found.append(int(process.name))
    return found


def assert_all_are_graded(folder: Path) -> None:
    queue = Queue(folder / "queue")
    assert queue.waiting() == ()
    assert len(queue.entries()) == WORKS
    assert all(
        (result := queue.result(entry.key or "")) is not None and result.points > 0
        for entry in queue.entries()
    )


@pytest.fixture
def slurm(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mapping[str, str]]:
    if problem := why_impossible():
        pytest.skip(problem)
    with one_node_cluster(tmp_path_factory.mktemp("slurm")) as environment:
        yield environment


def test_a_killed_task_of_slurm_says_that_the_same_command_goes_on(
    slurm: Mapping[str, str], handed_in: Path
) -> None:
    asked = {
        "account": "teaching",
        "partition": PARTITION,
        "qos": "normal",
        "time": "00:30:00",
        "memory": "512M",
    }
    how = ["--executor", "slurm", "--jobs", "2"]
    for name, value in asked.items():
        how += ["--slurm", f"{name}={value}"]
    running = grade(handed_in, slurm, *how)
    wait_until(lambda: graded(handed_in) >= 1, "the first result", limit_s=LIMIT_S)
    (task, *_) = wait_for_task(handed_in)
    os.kill(task, signal.SIGKILL)
    said = running.communicate(timeout=LIMIT_S)
    script = (handed_in / "queue" / "slurm.sh").read_text()
    assert re.findall(r"#SBATCH --(account|partition|qos|time|mem)=(\S+)", script) == [
        ("mem" if name == "memory" else name, value) for name, value in asked.items()
    ]
    assert running.returncode == 2, said
    assert "run the same command" in said[1]
    assert 0 < graded(handed_in) < WORKS
    again = grade(handed_in, slurm, *how)
    said = again.communicate(timeout=LIMIT_S)
    assert again.returncode == 0, said
    assert_all_are_graded(handed_in)


def wait_for_task(folder: Path) -> list[int]:
    found: list[int] = []

    def runs() -> bool:
        found[:] = processes("grader", "work", str(folder / "queue"), "--shard")
        return bool(found)

    wait_until(runs, "a task of the array job", limit_s=LIMIT_S)
    return found


def test_what_the_cluster_refuses_is_said(slurm: Mapping[str, str], handed_in: Path) -> None:
    running = grade(handed_in, slurm, "--executor", "slurm", "--slurm", "partition=nobodys")
    said = running.communicate(timeout=LIMIT_S)[1]
    assert running.returncode == 2
    assert "partition" in said
    assert "--slurm" in said
    assert "Traceback" not in said


@pytest.mark.skipif(find_spec("distributed") is None, reason="the extra `cluster` is not installed")
def test_killed_workers_of_dask_lose_nothing(handed_in: Path) -> None:
    from distributed import LocalCluster

    options = {"threads_per_worker": 1, "dashboard_address": None, "silence_logs": "CRITICAL"}
    with LocalCluster(n_workers=2, **options, local_directory=str(handed_in)) as cluster:
        running = grade(handed_in, os.environ, "--executor", "dask", "--cluster", cluster.scheduler_address)
        wait_until(lambda: graded(handed_in) >= 1, "the first result", limit_s=LIMIT_S)
        first, second = (worker.pid for worker in cluster.workers.values())
        os.kill(first, signal.SIGKILL)
        wait_until(lambda: graded(handed_in) >= WORKS // 2, "half of the results", limit_s=LIMIT_S)
        os.kill(second, signal.SIGKILL)
        said = running.communicate(timeout=LIMIT_S)
    if running.returncode:
        assert "run the same command" in said[1], said
        assert grade(handed_in, os.environ).wait(LIMIT_S) == 0
    assert_all_are_graded(handed_in)
    for file in (handed_in / "queue" / "results").glob("*.json"):
        json.loads(file.read_text())
