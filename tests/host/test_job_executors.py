"""Jobs by key: every one is done once, a worker that dies costs its own job alone, shares and scripts name all jobs."""

from __future__ import annotations

import io
import sys
from pathlib import Path

import pytest

from kit.host.job_executors import (
    MAX_TRIES,
    ExecutorUnavailable,
    JobPool,
    SlurmResources,
    in_shard,
    read_shard,
    run_on_slurm,
    serve_jobs,
    slurm_script,
)

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
