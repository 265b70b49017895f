"""Jobs by key: every one is done once, a worker that dies costs its own job alone, shares and scripts name all jobs."""

from __future__ import annotations

import io
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import ClassVar

import pytest

from kit.host import job_executors
from kit.host.job_executors import (
    MAX_TRIES,
    STOP_S,
    ExecutorUnavailable,
    JobPool,
    SlurmResources,
    in_shard,
    read_shard,
    run_on_slurm,
    serve_jobs,
    slurm_script,
)
from tests.waiting import wait_until

WORKER = """
import sys
from pathlib import Path
from kit.host.job_executors import serve_jobs
folder = Path(sys.argv[1])
def run(key):
    if key.startswith("dead"):
        (folder / f"{key}-{len(list(folder.glob(key + '*')))}").touch()
        sys.exit(1)
    (folder / key).touch()
serve_jobs(run, sys.stdin, sys.stdout)
"""


def test_every_job_is_done_and_one_that_kills_its_worker_is_lost(tmp_path: Path) -> None:
    keys, done, lost = ["a1", "dead", "b2", "c3"], list[str](), list[str]()
    JobPool([sys.executable, "-c", WORKER, str(tmp_path)], keys, 2, done.append, lost.append).run()
    assert sorted(done) == sorted(keys)
    assert lost == ["dead"]
    assert len(list(tmp_path.glob("dead-*"))) == MAX_TRIES
    assert all((tmp_path / key).exists() for key in ("a1", "b2", "c3"))


def test_what_goes_wrong_where_jobs_are_counted_ends_the_pool(tmp_path: Path) -> None:
    def full(key: str) -> None:
        raise OSError("the disk is full")

    with pytest.raises(OSError, match="full"):
        JobPool([sys.executable, "-c", WORKER, str(tmp_path)], ["a", "b"], 1, full, full).run()


STUBBORN = """
import signal, sys
from pathlib import Path
folder = Path(sys.argv[1])
def end(*_):
    (folder / "asked").touch()
    if len(sys.argv) == 2:
        sys.exit(1)
signal.signal(signal.SIGTERM, end)
for line in sys.stdin:
    if line == "first\\n":
        print("done first", flush=True)
        continue
    (folder / "began").touch()
    while True:
        signal.pause()
"""


class _InterruptedPool(JobPool):
    """A pool whose process is interrupted while a worker is being started: the second one of two."""

    started: ClassVar[list[subprocess.Popen[str]]] = []

    def _start(self) -> subprocess.Popen[str]:
        if self.started:
            os.kill(os.getpid(), signal.SIGINT)
            wait_until(lambda: self._is_stopped)
        self.started.append(super()._start())
        return self.started[-1]


def test_a_worker_that_is_started_while_the_pool_is_ended_gets_no_job(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It would run it to its end, which nobody waits for any more."""
    monkeypatch.setattr(_InterruptedPool, "started", [])
    command = [sys.executable, "-c", WORKER, str(tmp_path)]
    with pytest.raises(KeyboardInterrupt):
        _InterruptedPool(command, ["dead", "b2"], 1, list[str]().append, list[str]().append).run()
    assert [each.wait() is not None for each in _InterruptedPool.started] == [True, True]
    assert [file.name for file in tmp_path.iterdir()] == ["dead-0"]


def test_workers_that_do_not_end_when_they_are_asked_are_killed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(job_executors, "STOP_S", 0.2)

    def interrupt(key: str) -> None:
        os.kill(os.getpid(), signal.SIGINT)

    command = [sys.executable, "-c", STUBBORN, str(tmp_path), "stubborn"]
    with pytest.raises(KeyboardInterrupt):
        JobPool(command, ["first", "second"], 1, interrupt, interrupt).run()


def test_a_second_interruption_kills_workers_at_once(tmp_path: Path) -> None:
    def interrupt_twice() -> None:
        for name in ("began", "asked"):
            wait_until((tmp_path / name).exists)
            os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=interrupt_twice).start()
    command = [sys.executable, "-c", STUBBORN, str(tmp_path), "stubborn"]
    began = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        JobPool(command, ["second"], 1, list[str]().append, list[str]().append).run()
    assert time.monotonic() - began < STOP_S


def test_a_server_answers_when_a_job_is_done() -> None:
    jobs, answers = list[str](), io.StringIO()
    serve_jobs(jobs.append, io.StringIO("a1\nb2\n"), answers)
    assert jobs == ["a1", "b2"]
    assert answers.getvalue() == "done a1\ndone b2\n"


def test_shards_are_read_and_share_the_keys() -> None:
    assert [read_shard(text) for text in ("0/4", "3/4", "4/4", "1", "a/b")] == [
        (0, 4),
        (3, 4),
        None,
        None,
        None,
    ]
    keys = [f"{number:032x}" for number in range(0, 700, 7)]
    shares = [[key for key in keys if in_shard(key, (number, 3))] for number in range(3)]
    assert sorted(key for share in shares for key in share) == keys
    assert all(shares)


def test_an_array_job_has_a_task_for_each_share(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = slurm_script(tmp_path, ["python3", "-m", "my module"], 5, "jobs")
    assert "--array=0-4" in text
    assert "exec python3 -m 'my module' --shard \"$SLURM_ARRAY_TASK_ID/5\"" in text
    monkeypatch.setenv("PATH", "/nowhere")
    with pytest.raises(ExecutorUnavailable, match=r"sbatch .*slurm\.sh"):
        run_on_slurm(tmp_path, text, lambda: True)
    assert (tmp_path / "slurm.sh").read_text() == text


def test_a_script_asks_for_what_is_given() -> None:
    given = ["account=robots", "partition=short", "qos=night", "time=08:00:00", "memory=8G"]
    text = slurm_script(Path("/q"), ["x"], 2, "jobs", SlurmResources.read(given))
    for line in ("account=robots", "partition=short", "qos=night", "time=08:00:00", "mem=8G"):
        assert f"#SBATCH --{line}\n" in text
    assert "--account" not in slurm_script(Path("/q"), ["x"], 2, "jobs")


@pytest.mark.parametrize("given", ["acount=x", "account", "account=a b", "time=1\n#SBATCH --wrap=x", "qos="])
def test_what_would_be_another_line_of_the_script_is_refused(given: str) -> None:
    with pytest.raises(ValueError, match=r"NAME=VALUE|letters"):
        SlurmResources.read([given])
