"""A class: graded once, resumed anywhere, the same however it is done."""

from __future__ import annotations

import csv
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from datetime import UTC, datetime, timedelta, tzinfo
from importlib.util import find_spec
from pathlib import Path
from types import SimpleNamespace
from typing import Final

import pytest
from click.testing import CliRunner

from grader import version
from grader.__main__ import main
from grader.assignment import Assignment
from grader.cohort import gradebook
from grader.cohort.choice_rules import RULES, choose_submissions
from grader.cohort.gradebook import GradebookRow, as_csv, as_json, gradebook_rows
from grader.cohort.gradebook_changes import changes
from grader.cohort.lateness import LatePolicy, find_zone, parse_time, read_policy
from grader.cohort.queue import (
    Queue,
    QueueError,
    job_key,
    prepare_queue,
)
from grader.cohort.submission_times import SubmissionTime, read_submission_times
from grader.grading import GradingOptions
from grader.reading import read_assignment
from grader.submission import read_submission
from kit.host.job_executors import ExecutorUnavailable, JobPool
from kit.host.job_folder import JobExecutor
from kit.host.sandbox import probe
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import GradingVerdict
from kit.world.problems import WorldError
from tests.cases import every_case
from tests.grader.conftest import FORWARD, LOCKS, QUICK, write_assignment

TERMS = GradingOptions(Level.LIMITED, may_lower_level=False)
DUE = datetime(2026, 11, 30, 12, tzinfo=UTC)


def submissions(folder: Path, count: int = 3) -> Path:
    folder.mkdir()
    for number in range(count):
        (folder / f"s{number}.py").write_text(
            FORWARD.replace("SPEED = 0.3", f"SPEED = {0.05 + 0.1 * number}")
        )
    (folder / "broken.py").write_text("1/0\n")
    (folder / "copy.py").write_text(FORWARD.replace("SPEED = 0.3", "SPEED = 0.05"))
    (folder / "link.py").symlink_to("/etc/passwd")
    return folder


@pytest.fixture
def queue(tmp_path: Path) -> Queue:
    assignment = read_assignment(write_assignment(tmp_path / "quick"))
    made = Queue(tmp_path / "queue")
    prepare_queue(made, submissions(tmp_path / "in"), assignment, TERMS)
    return made


@pytest.mark.long
def test_everybody_gets_a_row_and_equal_work_is_graded_once(queue: Queue) -> None:
    waiting = queue.waiting()
    assert len(waiting) == 4  # six entries, two of them equal, one refused
    for key in waiting:
        queue.run_job(key)
    table = gradebook_rows(queue)
    assert [row.name for row in table] == ["broken", "copy", "link", "s0", "s1", "s2"]
    assert [row.verdict for row in table] == ["fail", "fail", "unreadable", "fail", "fail", "fail"]
    points = {row.name: row.points for row in table}
    assert (points["broken"], points["link"]) == (0.0, None)
    assert points["copy"] == points["s0"]
    assert points["s0"] < points["s1"] <= points["s2"]  # type: ignore[operator]  # all have a grade
    assert queue.waiting() == ()


@pytest.mark.long
def test_processes_and_one_process_give_the_same_bytes(queue: Queue, tmp_path: Path) -> None:
    done: list[str] = []
    JobExecutor(jobs=2).run(queue, queue.waiting(), done.append)
    assert len(done) == 4
    together = as_json(gradebook_rows(queue))
    other = Queue(tmp_path / "other")
    prepare_queue(other, tmp_path / "in", queue.assignment(), TERMS)
    for number in range(3):
        for key in other.waiting((number, 3)):
            Queue(other.folder).run_job(key)
    assert as_json(gradebook_rows(other)) == together


def test_shards_share_the_work(queue: Queue) -> None:
    shares = [set(queue.waiting((number, 3))) for number in range(3)]
    assert set.union(*shares) == set(queue.waiting())
    assert sum(map(len, shares)) == len(queue.waiting())


def test_a_damaged_result_is_made_again(queue: Queue) -> None:
    key = queue.waiting()[0]
    queue.run_job(key)
    assert key not in queue.waiting()
    for damaged in (b"", b"{", b"[]", b'{"schema": 99}'):
        queue.result_file(key).write_bytes(damaged)
        assert key in queue.waiting()


@pytest.mark.parametrize("worker", ["input()", "import time; time.sleep(600)"], ids=["dies", "stands still"])
def test_a_worker_that_fails_is_nobodys_fault(
    worker: str, queue: Queue, monkeypatch: pytest.MonkeyPatch
) -> None:
    key = queue.waiting()[0]

    def failing(self: JobPool) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [sys.executable, "-c", worker], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    monkeypatch.setattr(JobPool, "_start", failing)
    monkeypatch.setattr("grader.cohort.queue.GRACE_S", 0.3 - queue.assignment().submission_limit_s)
    JobExecutor(jobs=1).run(queue, [key], lambda key: None)
    result = queue.result(key)
    assert result is not None
    assert (result.verdict, result.points) == (GradingVerdict.BROKEN, None)
    assert [row.final for row in gradebook_rows(queue) if row.verdict == "broken"] in ([None], [None, None])


def test_the_key_is_what_decides_the_result(queue: Queue, tmp_path: Path) -> None:
    assignment = queue.assignment()
    submission = read_submission(tmp_path / "in" / "s0.py", assignment.submit)
    key = job_key(submission, assignment, TERMS)
    assert job_key(read_submission(tmp_path / "in" / "copy.py", assignment.submit), assignment, TERMS) == key
    assert job_key(submission, assignment, GradingOptions(Level.FILTERED)) != key
    assert job_key(submission, assignment, GradingOptions(Level.LIMITED, secret=True)) != key
    changed = read_assignment(write_assignment(tmp_path / "quick2", QUICK.replace("points: 3", "points: 4")))
    assert job_key(submission, changed, TERMS) != key


@pytest.mark.long
def test_another_grader_grades_anew(queue: Queue, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its code may be brought up to date without another version number."""
    for key in queue.waiting():
        queue.run_job(key)
    assert version.grader_version() == version.grader_version.__wrapped__()
    seen = list(version._source_files())
    assert {name.partition("/")[0] for name, _ in seen} == {"grader", "kit", "maps"}
    edited = tmp_path / "edited.py"
    edited.write_text(Path(seen[0][1]).read_text() + "# another line\n")
    monkeypatch.setattr(version, "_source_files", lambda: [(seen[0][0], str(edited)), *seen[1:]])
    other = version.grader_version.__wrapped__()
    assert other != version.grader_version()
    monkeypatch.setattr("grader.cohort.queue.grader_version", lambda: other)
    prepare_queue(queue, tmp_path / "in", queue.assignment(), TERMS)
    assert len(queue.waiting()) == 4


@pytest.mark.long
def test_a_new_assignment_grades_anew_and_says_what_changed(queue: Queue, tmp_path: Path) -> None:
    for key in queue.waiting():
        queue.run_job(key)
    before = gradebook_rows(queue)
    changed = read_assignment(write_assignment(tmp_path / "quick", QUICK.replace("full: 0.5", "full: 5")))
    prepare_queue(queue, tmp_path / "in", changed, TERMS)
    assert len(queue.waiting()) == 4
    for key in queue.waiting():
        queue.run_job(key)
    told = list(changes(before, gradebook_rows(queue)))
    assert any(line.startswith("s2: 3 -> ") and "pass -> partial)" in line for line in told)
    assert not any(line.startswith(("broken", "link")) for line in told)
    assert list(changes(before, gradebook.read_json(as_json(before)))) == []


def test_a_spreadsheet_gets_no_formula() -> None:
    row = GradebookRow("=cmd()", "fail", 1.0, 2.0, 1.0, 1.0, {"a": 1.0}, {"a": "pass"}, "@x\n+1", "")
    lines = as_csv([row, replace(row, name="x;=1+1", note='"=1";=1')]).splitlines()
    assert lines[1].startswith('"\'=cmd()","fail","1",')
    assert '"\'@x +1"' in lines[1]
    assert lines[2].startswith('"x;=1+1","fail"')
    assert lines[2].endswith(',"""=1"";=1"')
    cells = list(csv.reader(lines))
    assert cells[2][0] == "x;=1+1"
    assert all(line.count('","') == len(cells[0]) - 1 for line in lines), "every cell is in quotes"


@every_case(
    ("late", "kept"),
    [(-1.0, 1.0), (0.0, 1.0), (0.2, 1.0), (0.3, 0.9), (24.3, 0.8), (24 * 6.0, 0.5), (24 * 20.0, 0.0)],
)
def test_lateness(late: float, kept: float) -> None:
    policy = LatePolicy(DUE, grace_s=900, per_day=0.1, least=0.5, latest_days=10)
    assert policy.kept_share(DUE + timedelta(hours=late)) == pytest.approx(kept)


@pytest.mark.long
def test_late_rules_are_applied_when_the_table_is_made(queue: Queue, tmp_path: Path) -> None:
    for key in queue.waiting():
        queue.run_job(key)
    policy_file, times_file = tmp_path / "late.yaml", tmp_path / "times.csv"
    policy_file.write_text("due: 2026-11-30T12:00:00Z\nper_day: 0.5\n")
    times_file.write_text("name,submitted\ns2,2026-11-30T13:00:00Z\ns1,2026-11-30T11:00:00Z\n")
    results = {path.name: path.read_bytes() for path in (queue.folder / "results").iterdir()}
    table = {
        row.name: row
        for row in gradebook_rows(queue, read_policy(policy_file), read_submission_times(times_file))
    }
    assert (table["s2"].kept, table["s1"].kept) == (0.5, 1.0)
    assert table["s2"].final == table["s2"].points / 2  # type: ignore[operator]  # it has a grade
    assert results == {path.name: path.read_bytes() for path in (queue.folder / "results").iterdir()}
    policy_file.write_text("due: tomorrow\nper_dya: 1\n")
    with pytest.raises(WorldError, match=r"late\.yaml:1:6.*\n.*late\.yaml:2:1"):
        read_policy(policy_file)
    times_file.write_text("name,submitted\ns2,never\n")
    with pytest.raises(ValueError, match=r"times\.csv:2"):
        read_submission_times(times_file)
    assert parse_time("2026-11-30T12:00:00+01:00") == datetime(2026, 11, 30, 11, tzinfo=UTC)


def handed(name: str, final: float | None, kept: float = 1.0, note: str = "") -> GradebookRow:
    return GradebookRow(name, "fail", final, 10.0, kept, final, {}, {}, note, "")


@pytest.mark.parametrize(("rule", "counts"), [("latest", "ada-3"), ("in-time", "ada-2"), ("best", "ada-1")])
def test_one_of_several_submissions_counts(rule: str, counts: str) -> None:
    table = [
        *(handed("ada-1", 9.0), handed("ada-2", 5.0), handed("ada-3", 4.0, kept=0.5), handed("bob", 1.0)),
        handed("eve-1", 2.0, note="bumps"),
    ]
    arrivals = {
        row.name: SubmissionTime(DUE + timedelta(hours=hour), row.name.partition("-")[0])
        for hour, row in enumerate(table)
        if row.name != "bob"
    }
    ada, bob, eve = choose_submissions(table, arrivals, rule)
    assert (ada.name, ada.note) == ("ada", f"{counts}, {RULES[rule][0]} of 3")
    assert ada.final == {row.name: row.final for row in table}[counts]
    assert (bob.name, bob.final, eve.name, eve.note) == ("bob", 1.0, "eve", "bumps")
    assert choose_submissions(table[::-1], arrivals, rule) == (ada, bob, eve)
    assert choose_submissions(table, arrivals | {"zoe": arrivals["eve-1"]}, rule) == (ada, bob, eve)


def test_a_submission_without_a_grade_is_not_passed_over() -> None:
    table = [handed("ada-1", 9.0), handed("ada-2", None)]
    arrivals = {row.name: SubmissionTime(DUE, "ada") for row in table}
    assert choose_submissions(table, arrivals, "best")[0].final is None


def test_the_gradebook_says_which_counts_and_who_has_no_time(queue: Queue, tmp_path: Path) -> None:
    times, late = tmp_path / "times.csv", tmp_path / "late.yaml"
    times.write_text(
        "name,submitted,student\ns0,2026-11-30T11:00:00Z,ada\ns1,2026-11-29T11:00:00Z,ada\ns2,2026-11-29T11:00:00Z,\n"
    )
    late.write_text("due: 2026-11-30T12:00:00Z\n")
    book = ["gradebook", str(queue.folder), "--times", str(times), "--late", str(late), "--json"]
    done = CliRunner().invoke(main, book)
    assert done.exit_code == 0
    assert "3 without a time count as in time: broken, copy, link" in done.stderr
    table = {row.name: row for row in gradebook.read_json(done.stdout)}
    assert list(table) == ["ada", "broken", "copy", "link", "s2"]
    assert table["ada"].note.startswith("s0, the latest of 2")
    times.write_text("name,submitted\nnobody,2026-11-30T11:00:00Z\n")
    done = CliRunner().invoke(main, book)
    assert (done.exit_code, "1 time of no submission: nobody" in done.stderr) == (0, True)


@pytest.mark.long
def test_an_array_job_works_off_its_shares(
    queue: Queue, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With a stand-in for sbatch that runs the script's tasks one after the other."""
    bin_folder = tmp_path / "bin"
    bin_folder.mkdir()
    sbatch = bin_folder / "sbatch"
    sbatch.write_text('#!/bin/sh\nfor i in 0 1; do SLURM_ARRAY_TASK_ID=$i sh "$2" || exit 1; done\n')
    sbatch.chmod(0o755)
    monkeypatch.setenv("PATH", f"{bin_folder}:{os.environ['PATH']}")
    JobExecutor("slurm", 2).run(queue, queue.waiting(), print)
    assert queue.waiting() == ()
    assert "#SBATCH --array=0-1" in (queue.folder / "slurm.sh").read_text()


def test_what_a_machine_lacks_is_said(queue: Queue, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "/nowhere")
    with pytest.raises(ExecutorUnavailable, match="sbatch"):
        JobExecutor("slurm", 2).run(queue, queue.waiting(), print)
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(ExecutorUnavailable, match=r"pip install .*distributed|\[cluster\]"):
        JobExecutor("dask", cluster="tcp://nowhere:1").run(queue, queue.waiting(), lambda key: None)
    with pytest.raises(QueueError, match="grader cohort"):
        Queue(queue.folder / "none").entries()


class Future:
    """A task that is over."""

    def __init__(self, problem: Exception | None) -> None:
        self._problem = problem

    def exception(self) -> Exception | None:
        if isinstance(self._problem, LookupError):  # what Dask does for a task that was cancelled
            raise self._problem
        return self._problem


class StandIn:
    """For ``distributed``: runs what it is given here, but for one job, which takes its worker with it."""

    class KilledWorker(Exception):
        """What Dask says when a task has ended several workers."""

    def __init__(self, deadly: str, problem: Exception | None = None) -> None:
        self.deadly = deadly
        self.problem = problem or self.KilledWorker()
        self.has_workers = True

    def wait(self, futures: list[Future], *, timeout: float | None, return_when: str) -> SimpleNamespace:
        assert timeout is not None, "a cluster that stands still is not waited for"
        if not self.has_workers:
            raise TimeoutError
        return SimpleNamespace(done=futures[:1], not_done=futures[1:])

    def Client(self, address: str) -> StandIn:
        assert address == "tcp://cluster:1"
        return self

    def __enter__(self) -> StandIn:
        return self

    def __exit__(self, *error: object) -> None:
        """Nothing to close."""

    def submit(self, function: Callable[..., None], *names: str, **options: object) -> Future:
        assert all(isinstance(each, str) for each in names)
        problem = self.problem if names[-1] == self.deadly else None
        if problem is None and self.has_workers:
            function(*names)
        return Future(problem)


@pytest.mark.long
def test_a_cluster_gets_names_alone_and_outlives_a_job_that_kills(
    queue: Queue, monkeypatch: pytest.MonkeyPatch
) -> None:
    keys = queue.waiting()
    monkeypatch.setitem(sys.modules, "distributed", StandIn(keys[1]))  # type: ignore[arg-type]  # a stand-in
    done: list[str] = []
    JobExecutor("dask", cluster="tcp://cluster:1").run(queue, keys, done.append)
    assert sorted(done) == sorted(keys)
    assert queue.waiting() == ()
    verdicts = [result.verdict for key in keys if (result := queue.result(key)) is not None]
    assert [verdict is GradingVerdict.BROKEN for verdict in verdicts] == [False, True, False, False]
    with pytest.raises(ExecutorUnavailable, match="--cluster"):
        JobExecutor("dask", cluster="").run(queue, keys, done.append)


@pytest.mark.parametrize(
    "problem", [OSError(28, "No space left on device"), LookupError("cancelled")], ids=str
)
def test_a_job_that_fails_on_the_cluster_costs_no_other_job_its_result(
    problem: Exception, queue: Queue, monkeypatch: pytest.MonkeyPatch
) -> None:
    keys = queue.waiting()
    monkeypatch.setitem(sys.modules, "distributed", StandIn(keys[0], problem))  # type: ignore[arg-type]
    monkeypatch.setattr(Queue, "run_job", Queue.record_loss)
    done: list[str] = []
    with pytest.raises(ExecutorUnavailable, match=r"1 of 4 jobs failed .*the same command"):
        JobExecutor("dask", cluster="tcp://cluster:1").run(queue, keys, done.append)
    assert sorted(done) == sorted(keys)
    assert queue.waiting() == keys[:1]


def test_a_cluster_without_workers_is_not_waited_for(queue: Queue, monkeypatch: pytest.MonkeyPatch) -> None:
    cluster = StandIn("none")
    cluster.has_workers = False
    monkeypatch.setitem(sys.modules, "distributed", cluster)  # type: ignore[arg-type]  # a stand-in
    with pytest.raises(ExecutorUnavailable, match="does the scheduler have workers"):
        JobExecutor("dask", cluster="tcp://cluster:1").run(queue, queue.waiting(), lambda key: None)


@pytest.mark.long
@pytest.mark.skipif(find_spec("distributed") is None, reason="the extra `cluster` is not installed")
def test_a_real_cluster_gives_the_same_bytes(queue: Queue, tmp_path: Path) -> None:
    """Two workers, each a process that Dask started."""
    from distributed import LocalCluster

    other = Queue(tmp_path / "other")
    prepare_queue(other, tmp_path / "in", queue.assignment(), TERMS)
    JobExecutor(jobs=1).run(other, other.waiting(), lambda key: None)
    done: list[str] = []
    options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None, "silence_logs": "ERROR"}
    with LocalCluster(**options, local_directory=str(tmp_path)) as cluster:
        JobExecutor("dask", cluster=cluster.scheduler_address).run(queue, queue.waiting(), done.append)
    assert len(done) == 4
    assert as_json(gradebook_rows(queue)) == as_json(gradebook_rows(other))


@pytest.mark.long
@LOCKS
def test_levels_do_not_change_points(tmp_path: Path) -> None:
    assignment = read_assignment(write_assignment(tmp_path / "quick"))
    folder = submissions(tmp_path / "in")
    tables = []
    levels = [support.level for support in probe.probe_levels() if support.is_available]
    assert len(levels) >= 2
    for level in levels:
        made = Queue(tmp_path / f"queue{int(level)}")
        prepare_queue(made, folder, assignment, GradingOptions(level, may_lower_level=False))
        for key in made.waiting():
            made.run_job(key)
        tables.append([(row.name, row.points, dict(row.tests)) for row in gradebook_rows(made)])
    assert all(table == tables[0] for table in tables)


def command(tmp_path: Path) -> list[str]:
    return [
        *(
            sys.executable,
            "-P",
            "-m",
            "grader",
            "cohort",
            str(tmp_path / "in"),
            "--jobs",
            "2",
            "--level",
            "0",
        ),
        *("--assignment", str(tmp_path / "quick"), "--queue", str(tmp_path / "queue")),
    ]


@pytest.mark.long
def test_the_command_makes_a_gradebook_and_goes_on(tmp_path: Path) -> None:
    write_assignment(tmp_path / "quick")
    submissions(tmp_path / "in", 2)
    first = subprocess.run(command(tmp_path), capture_output=True, text=True, check=False)
    assert first.returncode == 1, first.stderr
    assert "4 fail, 1 unreadable" in first.stdout
    assert first.stdout.splitlines()[-3:] == [
        "1 has no grade and needs your attention:",
        "  link: unreadable. link.py is a link; hand in the file itself.",
        "The same work to the byte: copy, s0.",
    ]
    before = (tmp_path / "queue" / "gradebook.json").read_bytes()
    assert len(json.loads(before)) == 5
    again = subprocess.run(command(tmp_path), capture_output=True, text=True, check=False)
    assert "0 to grade" in again.stderr
    assert (tmp_path / "queue" / "gradebook.json").read_bytes() == before


def results(tmp_path: Path) -> int:
    """How many there are so far."""
    return len(list((tmp_path / "queue" / "results").glob("*.json")))


def below(folder: Path) -> set[int]:
    """Processes that work in this folder."""
    found = set()
    for entry in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):  # over, or another user's
            if (entry / "cwd").resolve().is_relative_to(folder):
                found.add(int(entry.name))
    return found


@pytest.mark.nightly
@pytest.mark.timeout(900)
def test_killed_at_twenty_moments_and_resumed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The gradebook of a cohort that was killed again and again is that of one that was left in peace."""
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    monkeypatch.setenv("TMPDIR", str(scratch))  # where every program that is graded works
    write_assignment(tmp_path / "quick")
    submissions(tmp_path / "in", 70)
    assert subprocess.run(command(tmp_path), capture_output=True, check=False).returncode == 1  # the link
    undisturbed = (tmp_path / "queue" / "gradebook.json").read_bytes()
    whole = results(tmp_path)
    shutil.rmtree(tmp_path / "queue")
    chance = random.Random(7)
    for number in range(20):
        before = results(tmp_path)
        running = subprocess.Popen(
            command(tmp_path), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
        )
        if number % 2:  # while it grades
            wanted = before + chance.randint(1, 4)
            while results(tmp_path) < wanted and running.poll() is None:
                time.sleep(0.005)
            time.sleep(chance.uniform(0.0, 0.2))
        else:  # while it starts, looks through what was handed in, or begins to grade
            time.sleep(chance.uniform(0.0, 1.5))
        assert running.poll() is None, "it was killed at work"
        if number % 3:
            os.killpg(running.pid, signal.SIGKILL)
        else:  # its workers find out by themselves
            running.kill()
        running.wait()
    assert 10 <= results(tmp_path) < whole, "every kill came in the middle"
    subprocess.run(command(tmp_path), capture_output=True, check=False)
    assert (tmp_path / "queue" / "gradebook.json").read_bytes() == undisturbed
    if sys.platform == "linux":
        deadline = time.monotonic() + 20
        while below(scratch) and time.monotonic() < deadline:
            time.sleep(0.1)
        assert below(scratch) == set(), "nothing that was graded outlives its grader"


def verb(name: str, *arguments: object) -> tuple[int, str]:
    done = CliRunner().invoke(main, [name, *map(str, arguments)])
    return done.exit_code, done.output


def one_of_a_class(tmp_path: Path) -> list[object]:
    """A class of one and an assignment that says level 0, as ``grader cohort`` takes them."""
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "ada.py").write_text(FORWARD)
    folder = write_assignment(tmp_path / "quick")
    assert read_assignment(folder).level is Level.LIMITED
    return [tmp_path / "in", "--assignment", folder, "--queue", tmp_path / "queue", "--jobs", "1"]


@pytest.mark.long
@LOCKS
def test_a_class_is_not_graded_at_level_0_by_silence(tmp_path: Path) -> None:
    asked = one_of_a_class(tmp_path)
    code, told = verb("cohort", *asked)
    queue = Queue(tmp_path / "queue")
    highest = int(probe.highest_level_up_to(Level.ANOTHER_USER))
    assert highest >= 1
    assert (code, queue.manifest().level, gradebook_rows(queue)[0].level) == (0, highest, highest)
    assert f"1 fail, at confinement level {highest}: " in told
    assert json.loads(next((queue.folder / "results").iterdir()).read_bytes())["level"] == highest
    code, told = verb("cohort", *asked, "--level", "1")
    assert (code, gradebook_rows(queue)[0].level) == (0, 1)
    code, told = verb("cohort", *asked, "--level", "0")
    assert (code, gradebook_rows(queue)[0].level) == (0, 0)
    assert "1 fail, at confinement level 0: " in told


@pytest.mark.long
@pytest.mark.usefixtures("no_level_1")
def test_a_machine_no_level_1_grades_no_class_unless_told(tmp_path: Path) -> None:
    asked = one_of_a_class(tmp_path)
    code, told = verb("cohort", *asked)
    assert (code, "level 1; `kit doctor`" in told, "--level 0" in told) == (2, True, True)
    assert not (tmp_path / "queue").exists()
    assert verb("cohort", *asked, "--executor", "none")[0] == 0  # others are to do the work
    code, told = verb("work", tmp_path / "queue")
    assert (code, "level 1; `kit doctor`" in told) == (2, True)
    assert verb("cohort", *asked, "--level", "0")[0] == 0


@pytest.mark.long
@LOCKS
def test_one_work_with_secrets_is_not_graded_at_level_0_by_silence(tmp_path: Path) -> None:
    folder, file = write_assignment(tmp_path / "quick", secret="seeds: {turn: [5]}"), tmp_path / "ada.py"
    file.write_text(FORWARD)
    asked = (file, "--assignment", folder, "--json")
    highest = int(probe.highest_level_up_to(Level.ANOTHER_USER))
    for more, level in (
        (("--secret",), highest),
        (("--secret", "--level", "0"), 0),
        ((), 1),
        (("--level", "highest"), highest),
    ):
        code, told = verb("check", *asked, *more)
        result = told[told.index("{") :]  # before it, on standard error: that the secret seeds were not used
        assert (code, json.loads(result)["level"]) == (1, level)


@pytest.mark.long
@pytest.mark.usefixtures("no_level_1")
def test_a_machine_no_level_1_uses_no_secrets_unless_told(tmp_path: Path) -> None:
    folder, file = write_assignment(tmp_path / "quick", secret="seeds: {turn: [5]}"), tmp_path / "ada.py"
    file.write_text("1/0")
    code, told = verb("check", file, "--assignment", folder, "--secret")
    assert (code, "--level 0" in told) == (2, True)
    assert verb("check", file, "--assignment", folder, "--secret", "--level", "0")[0] == 1


LISBON, BERLIN = find_zone("Europe/Lisbon"), find_zone("Europe/Berlin")


@every_case(
    ("text", "zone", "read"),
    [
        ("2026-03-28T23:59:00+01:00", None, "2026-03-28T22:59:00"),
        ("2026-03-28T23:59:00Z", LISBON, "2026-03-28T23:59:00"),
        ("2026-07-01 12:00", LISBON, "2026-07-01T11:00:00"),  # summer time
        ("2026-07-01 12:00", find_zone("UTC"), "2026-07-01T12:00:00"),
        ("2026-03-28", BERLIN, "2026-03-28T22:59:59"),  # the end of the day
        ("2026-03-29", BERLIN, "2026-03-29T21:59:59"),  # of the day on which clocks change too
        ("2026-07-01 12:00", None, "no time zone"),
        ("2026-03-28", None, "no time zone"),
        ("2026-03-29 02:30", BERLIN, "comes never"),
        ("2026-10-25 02:30", BERLIN, "comes twice"),
        ("2026-03-28 24:00", BERLIN, "must be a date and time"),
        ("29/03/2026 23:59", BERLIN, "must be a date and time"),
        ("03.04.2026", BERLIN, "must be a date and time"),
        ("9999-12-31T23:59:59-12:00", None, "must be in the years"),
        ("0001-01-01T00:00:00+14:00", None, "must be in the years"),
    ],
)
def test_a_due_date_is_read_in_one_way_or_refused(text: str, zone: tzinfo | None, read: str) -> None:
    try:
        found = parse_time(text, zone, whole_day=True).astimezone(UTC).isoformat()
    except ValueError as problem:
        found = str(problem)
    assert found.removesuffix("+00:00") == read or (read[0].isalpha() and read in found)


def test_when_a_submission_came_needs_a_time_of_day() -> None:
    with pytest.raises(ValueError, match="names a day and no time"):
        parse_time("2026-03-28", BERLIN)


@pytest.mark.parametrize(
    ("rules", "kept"),
    [
        ("due: 2026-03-28\nzone: Europe/Lisbon\nper_day: 0.1\n", [1.0, 1.0, 0.8]),
        ("due: 2026-03-28\nzone: Europe/Berlin\nper_day: 0.1\n", [1.0, 0.9, 0.8]),
        ("due: 2026-03-28T23:30:00+01:00\nper_day: 0.1\n", [1.0, 0.9, 0.8]),
    ],
)
def test_the_end_of_the_day_is_meant_and_said(tmp_path: Path, rules: str, kept: list[float]) -> None:
    file, times = tmp_path / "late.yaml", tmp_path / "times.csv"
    file.write_text(rules)
    times.write_text(
        "name,submitted\na,2026-03-28T22:30:00Z\nb,2026-03-28T22:59:59.5Z\nc,2026-03-30T12:00:00+02:00\n"
    )
    policy = read_policy(file)
    submitted = read_submission_times(times, policy.zone)
    assert [policy.kept_share(each.at) for each in submitted.values()] == pytest.approx(kept)
    assert policy.due_text.startswith("due 2026-03-28 23:")


@pytest.mark.parametrize(
    "rules", ["due: 2026-07-01 12:00\n", "due: 2026-03-28\n", "due: 2026-03-28\nzone: Mars/Base\n"]
)
def test_a_due_date_in_no_zone_is_refused(tmp_path: Path, rules: str) -> None:
    file = tmp_path / "late.yaml"
    file.write_text(rules)
    with pytest.raises(WorldError, match="zone"):
        read_policy(file)


def test_clocks_that_change_take_no_hour_from_a_student(tmp_path: Path) -> None:
    policy = LatePolicy(parse_time("2026-03-28 23:00", BERLIN), per_day=0.1)
    assert policy.kept_share(parse_time("2026-03-29 23:30", BERLIN)) == pytest.approx(0.9)  # 23.5 h later


SAME_TO_THE_EYE: Final = str.maketrans(
    {"\u0430": "a", "\u03b1": "a", "\u043e": "o", "\u03bf": "o", "0": "o", "1": "i", "l": "i", "\u200b": None}
)
"""The letters of the names below that look alike."""


def as_seen(name: str) -> str:
    return " ".join(name.casefold().translate(SAME_TO_THE_EYE).split())


@pytest.mark.parametrize(
    "names",
    [
        ("ada", "ada "),
        ("ada lovelace", "ada\u00a0lovelace", "ada  lovelace"),
        ("ada", "Ada"),
        ("ada", "a\u200bda"),
        ("ada", "\u0430da", "ad\u03b1", "\u0410da"),
        ("bill", "bi11", "biIl"),
        ("otto", "0tt0", "\u03bftt\u043e"),
        ("s10", "s20", "s01"),
        ("\u0430\u043d\u043d\u0430", "\u0434\u0438\u043c\u0430"),
    ],
)
def test_no_two_names_of_a_class_look_alike(
    names: tuple[str, ...], tmp_path: Path, quick: Assignment
) -> None:
    folder = tmp_path / "in"
    for name in names:
        (folder / name).mkdir(parents=True)
        (folder / name / "controller.py").write_text(FORWARD)
    entries = prepare_queue(Queue(tmp_path / "queue"), folder, quick, TERMS)
    shown = {as_seen(each.name) for each in entries}
    assert len(shown) == len(names), shown
    if len({as_seen(name) for name in names}) == len(names):
        assert {each.name for each in entries} == set(names), "what looks like no other keeps its name"


@pytest.mark.parametrize("name", [".ada.py", ".ada", "VENV"])
def test_what_is_not_taken_for_a_work_is_said(name: str, tmp_path: Path) -> None:
    folder, work = write_assignment(tmp_path / "quick"), tmp_path / "in"
    (work / name).mkdir(parents=True)
    (work / name / "controller.py").write_text(FORWARD)
    code, told = verb(
        "cohort",
        work,
        "--assignment",
        folder,
        "--queue",
        tmp_path / "queue",
        "--executor",
        "none",
        "--level",
        "0",
    )
    assert code == 0
    assert f"Not graded: {name}." in told


@pytest.mark.long
def test_a_note_gives_a_ci_service_no_command(tmp_path: Path) -> None:
    folder = write_assignment(tmp_path / "quick")
    work = tmp_path / "in"
    work.mkdir()
    (work / "::error title=Passed::all.py").write_text("1/0\n")
    (work / "##[add-mask]x.pdf").write_text("x")
    code, told = verb("check", work, "--assignment", folder, "--level", "0")
    assert code == 1
    assert "all.py was taken as controller.py" in told
    assert "::" not in told
    assert "##[" not in told
