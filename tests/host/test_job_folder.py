"""A folder of jobs, run in processes of this machine, in shares, and in none."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import ClassVar

import pytest

from kit.host.job_executors import read_shard
from kit.host.job_folder import JobExecutor, JobFolder

WORKER = """
import sys
from pathlib import Path
from kit.host.job_folder import serve_keys
def run(key):
    print("noise that is no answer")
    if key == "dead":
        raise SystemExit(1)
    (Path(sys.argv[1]) / key).write_text("done")
serve_keys(run)
"""
KEYS = ("a0", "b1", "c2", "d3", "dead")


class Folder(JobFolder):
    """Its jobs write a file each; one kills its worker."""

    job_name: ClassVar[str] = "files"

    @property
    def worker_command(self) -> list[str]:
        return [sys.executable, "-c", WORKER, str(self.folder)]

    shard_command = worker_command

    def keys(self) -> Sequence[str]:
        return KEYS

    def is_waiting(self, key: str) -> bool:
        return not (self.folder / key).exists()

    def run_job(self, key: str) -> None:
        (self.folder / key).write_text("done")

    def record_loss(self, key: str) -> None:
        (self.folder / key).write_text("lost")


def test_every_job_is_run_once_and_one_that_kills_costs_no_other(tmp_path: Path) -> None:
    jobs, done = Folder(tmp_path), list[str]()
    jobs.run_job("c2")
    JobExecutor(jobs=2).run(jobs, jobs.waiting(), done.append)
    assert sorted(done) == ["a0", "b1", "d3", "dead"]
    assert jobs.waiting() == ()
    assert {each.name: each.read_text() for each in tmp_path.iterdir()} == {
        **dict.fromkeys(KEYS, "done"),
        "dead": "lost",
    }


@pytest.mark.parametrize("shares", ["1", "2", "3", "7"])
def test_shares_are_disjoint_and_whole(tmp_path: Path, shares: str) -> None:
    jobs = Folder(tmp_path)
    found = []
    for number in range(int(shares)):
        shard = read_shard(f"{number}/{shares}")
        assert shard is not None
        found += jobs.waiting(shard)
    assert sorted(found) == sorted(KEYS)


def test_nothing_is_run_nowhere(tmp_path: Path) -> None:
    jobs = Folder(tmp_path)
    JobExecutor("none").run(jobs, jobs.waiting(), pytest.fail)
    assert jobs.waiting() == KEYS


def test_a_result_that_cannot_be_saved_is_told_without_a_traceback(tmp_path: Path) -> None:
    command = [sys.executable, "-c", WORKER, str(tmp_path / "missing")]
    ended = subprocess.run(command, input="a0\n", capture_output=True, text=True, check=False)
    assert ended.returncode == 1
    assert ended.stderr.splitlines()[-1] == f"{tmp_path}/missing/a0: No such file or directory"
    assert "Traceback" not in ended.stderr
