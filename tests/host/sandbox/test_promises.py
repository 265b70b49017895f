"""Every row of the table of promises is tried, and ``.github/SECURITY.md`` shows the table.

``python -m tests.host.sandbox.test_promises`` writes the table into that file.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Mapping
from contextlib import nullcontext, suppress
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

import pytest

from grader.assignment import Assignment
from grader.evidence.evidence_scores import EvidenceScores
from grader.evidence.submission_clock import SubmissionClock
from kit.host import process, program_start, protocol
from kit.host.failure import StudentCodeError
from kit.host.sandbox import grants
from kit.host.sandbox.limits import MIB, Limits
from kit.host.sandbox.probe import can_mount_scratch, is_level_available
from kit.host.sandbox.promises import PROMISES, Promise, promises_since
from kit.host.sandbox.reaper import descendants
from kit.host.sandbox.sandbox_config import Level
from kit.host.student_functions import StudentFunctions
from tests.grader import test_returned_numbers, test_secrets
from tests.host import test_forgery, test_process, test_states
from tests.host.conftest import LINUX, QUICK, Student
from tests.host.sandbox import test_confinement, test_grants
from tests.host.sandbox.test_control_groups import without_groups

pytestmark = pytest.mark.usefixtures("cold_start")

function_assignment, speaks = test_secrets.function_assignment, test_states.speaks
"""Fixtures of the tests that are tried here without a defence."""
SECURITY: Final = Path(__file__).parents[3] / ".github" / "SECURITY.md"
BEGIN, END = "<!-- table of promises -->\n", "<!-- end of the table -->\n"

TRIALS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "stat": "return os.stat(secret).st_size",
        "list": "return os.stat(f'/proc/{grader}').st_nlink",
        "load": "return sum(os.getloadavg()) + os.sysconf('SC_AVPHYS_PAGES')",
    }
)
"""By promise: what returns more than 0 where the level does not prevent it."""

TESTS: Final[Mapping[str, tuple[Callable[..., Any], ...]]] = MappingProxyType(
    {
        "outlive": (
            test_process.test_a_daemon_is_not_left_behind,
            test_process.test_when_the_kit_dies_the_child_dies_too,
        ),
        "time": (
            test_process.test_what_never_comes_back_is_ended,
            test_process.test_the_budget_in_all,
            test_process.test_the_budget_of_processor_time,
        ),
        "memory": (test_process.test_memory_is_limited,),
        "inherit": (test_process.test_nothing_of_ours_is_in_its_surroundings,),
        "frames": (
            test_states.test_every_frame_in_every_state,
            test_forgery.test_a_forged_answer_ends_the_process,
        ),
        "solutions": (test_grants.test_every_package_but_ours_can_be_read,),
        "numbers": (
            test_returned_numbers.test_a_calculation_ends_with_the_submissions_time,
            test_returned_numbers.test_what_takes_too_long_to_measure_is_the_submissions_timeout,
        ),
        "order": (test_secrets.test_nothing_that_a_student_reads_of_is_run_after_a_secret_run,),
        "disk": (test_confinement.test_a_separate_program_is_alone_and_its_disk_is_small,),
        "threads": (test_confinement.test_threads_are_counted,),
        "user": (test_confinement.test_two_runs_have_two_users,),
    }
)
"""By promise: the tests elsewhere that try to break it."""


def markdown_table() -> str:
    """Returns the promises as a Markdown table with a column for each level."""
    rows = [["A student's program cannot", *(f"level {level:d}" for level in Level)]]
    rows.append(["---", *("---" for _ in Level)])
    rows += [[promise.action, *(_table_cell(promise, level) for level in Level)] for promise in PROMISES]
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)


def _table_cell(promise: Promise, level: Level) -> str:
    if not promise.holds_at(level):
        return "**possible**"
    # At level 0 the program has its user's rights: with intent it can undo all of it.
    return "not by accident" if level is Level.LIMITED else "prevented"


@pytest.fixture(params=list(Level), ids=lambda level: f"L{level}")
def level(request: pytest.FixtureRequest) -> Level:
    wanted: Level = request.param
    if not is_level_available(wanted):
        pytest.skip("not on this machine")
    return wanted


def find_promise(key: str) -> Promise:
    return next(promise for promise in PROMISES if promise.key == key)


def test_every_promise_is_tried() -> None:
    here = {*TRIALS, "access times", "locks", "cache"}
    keys = [*here, *TESTS, *test_confinement.ATTACKS_BY_PROMISE]
    assert sorted(keys) == sorted(promise.key for promise in PROMISES)
    for key in test_confinement.ATTACKS_BY_PROMISE:
        assert find_promise(key).since is Level.FILTERED, "the attacks are tried from level 1 on"


def test_the_file_shows_the_table() -> None:
    text = SECURITY.read_text(encoding="utf-8")
    assert text.count(BEGIN) == text.count(END) == 1
    assert text.partition(BEGIN)[2].partition(END)[0] == markdown_table()


def test_every_promise_belongs_to_one_level() -> None:
    shown = [promise for level in (*Level, None) for promise in promises_since(level)]
    assert sorted(shown, key=PROMISES.index) == list(PROMISES)


@LINUX
@pytest.mark.sampled(3)
@pytest.mark.parametrize("key", TRIALS)
def test_what_a_level_prevents_and_what_it_does_not(
    student: Student, tmp_path: Path, level: Level, key: str
) -> None:
    secret = tmp_path / "hidden" / "secret.yaml"
    secret.parent.mkdir()
    secret.write_text("seeds: [1, 2]")
    file = student(
        f"import os\ndef trial(secret, grader):\n    try: {TRIALS[key]}\n    except OSError: return 0\n"
    )
    record = {"secret": str(secret), "grader": os.getpid()}
    with StudentFunctions(file, limits=QUICK, level=level) as functions:
        (gained,) = functions.call_batch("trial", [record])
    assert (gained == 0) == find_promise(key).holds_at(level)


@pytest.mark.sampled(4)
def test_reading_leaves_no_trace_for_a_later_program(student: Student, level: Level) -> None:
    data = student("something", "data.txt")
    os.utime(data, (1, 10**6))  # older than its last change: what a disk with `relatime` takes note of
    data.read_bytes()
    is_noted = data.stat().st_atime != 1
    os.utime(data, (1, 10**6))
    file = student(f"def read(): return len(open({str(data)!r}).read())")
    with StudentFunctions(file, limits=QUICK, level=level) as functions:
        assert functions.call_batch("read", [{}]) == [9.0]
    assert (data.stat().st_atime == 1) == (find_promise("access times").holds_at(level) or not is_noted)


@pytest.mark.long
@LINUX
def test_a_lock_is_seen_by_another_program_at_every_level(student: Student, level: Level) -> None:
    """So that the table does not promise too little either."""
    file = student(
        """
        import fcntl
        held = open(__file__)
        def lock():
            try: fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError: return 0
            return 1
        """
    )
    with (
        StudentFunctions(file, limits=QUICK, level=level) as first,
        StudentFunctions(file, limits=QUICK, level=level) as second,
    ):
        got = [functions.call_batch("lock", [{}]) for functions in (first, second)]
    assert (got == [[1.0], [1.0]]) == find_promise("locks").holds_at(level)


@pytest.mark.long
@LINUX
def test_what_of_a_file_is_in_memory_is_seen_by_a_later_program_at_every_level(
    student: Student, tmp_path: Path, level: Level
) -> None:
    """One reads the file, or does not; the other counts the pages that it waits for. So the table promises no less than is so."""
    data = student("", "data.bin")
    pages, size = 64, 64 * 4096 * 16
    data.write_bytes(os.urandom(size))
    file = student(
        f"""
        import mmap, resource
        def read():
            with open({str(data)!r}, "rb") as opened: return len(opened.read())
        def waited():
            with open({str(data)!r}, "rb") as opened:
                mapped = mmap.mmap(opened.fileno(), 0, prot=mmap.PROT_READ)
                before = resource.getrusage(resource.RUSAGE_SELF).ru_majflt
                total = sum(mapped[place] for place in range(0, {size}, {size // pages})) * 0
                return total + resource.getrusage(resource.RUSAGE_SELF).ru_majflt - before
        """
    )
    seen = []
    for is_read in (False, True):
        with data.open("rb") as opened:
            os.fsync(opened.fileno())
            os.posix_fadvise(opened.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)
        with StudentFunctions(file, limits=QUICK, level=level) as functions:
            if is_read:
                functions.call_batch("read", [{}])
        with StudentFunctions(file, limits=QUICK, level=level) as functions:
            seen += functions.call_batch("waited", [{}])
    if seen[0] == 0:
        pytest.skip("this file system keeps its files in memory")
    assert (seen[1] < seen[0]) != find_promise("cache").holds_at(level)


def taking_away(name: str, instead: str) -> str:
    """The statements that replace a function; they fail where it is not, since then nothing would be taken away."""
    return f"assert callable({name}); {name} = {instead}; "


NO_FILTER = taking_away("confinement.seccomp.install", "lambda **options: None")
NO_LANDLOCK = taking_away("confinement.landlock.restrict", "lambda *granted: None")
NO_LIMITS = taking_away("confinement.set_limits", "lambda config: None")
WITHOUT_DEFENCE: Final[Mapping[str, tuple[str, tuple[str, ...]]]] = MappingProxyType(
    {
        "read": (NO_LANDLOCK, ("read a file outside", "list a folder outside", "read through a link")),
        "write": (NO_LANDLOCK, ("write a file outside", "make a file outside", "change its own source")),
        "attributes": (NO_FILTER, ("change a file's rights", "change a file's time", "read a file's flags")),
        "start": (NO_FILTER + NO_LANDLOCK, ("start a program", "spawn a program")),
        "network": (NO_FILTER, ("send over UDP", "open a local socket")),
        "processes": (
            NO_FILTER + NO_LANDLOCK + NO_LIMITS,
            ("signal the grader", "signal by descriptor", "use up the machine's requests", "use up its user's signals"),
        ),
        "rights": (NO_FILTER, ("make a namespace",)),
        "kernel": (NO_FILTER, ("use a keyring",)),
        "uncounted": (
            NO_FILTER,
            ("use memory that nobody counts", "use shared memory", "use semaphores", "use a message queue", "leave pages in a pipe", "widen a pipe"),
        ),
    }
)  # fmt: skip
"""By promise: what takes its defence away in a process that is confined to level 1 in all else, and attacks that then work."""


@pytest.mark.long
@LINUX
@pytest.mark.parametrize("key", WITHOUT_DEFENCE)
def test_a_promise_is_broken_where_its_defence_is_taken_away(
    student: Student, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, key: str
) -> None:
    """So each row rests on the defence that is thought to hold it, and its test would see that this is gone."""
    if not is_level_available(Level.FILTERED):
        pytest.skip("not on this machine")
    secret = tmp_path / "solution.txt"
    record = {"secret": str(secret), "grader": os.getpid()}
    taken_away, attacks = WITHOUT_DEFENCE[key]
    start = program_start._START
    gained: dict[str, list[str]] = {}
    for prelude in ("", f"from kit.host.sandbox import confinement; {taken_away}"):
        monkeypatch.setattr(program_start, "_START", start.replace("os._exit(", f"{prelude}os._exit("))
        gained[prelude] = []
        for name in attacks:
            secret.write_text("forty-two")
            (tmp_path / "solution.txt.new").unlink(missing_ok=True)
            file = test_confinement._attack_file(student)
            with StudentFunctions(file, limits=QUICK, level=Level.FILTERED) as functions:
                number = list(test_confinement.ATTACKS).index(name)
                if functions.call_batch(f"attack{number}", [record]) != [0.0]:
                    gained[prelude].append(name)
    assert list(gained.values()) == [[], list(attacks)]


def without(monkeypatch: pytest.MonkeyPatch, taken_away: str) -> None:
    """Takes something away in the processes that are started from now on."""
    prelude = f"from kit.host.sandbox import confinement; {taken_away}"
    monkeypatch.setattr(
        program_start, "_START", program_start._START.replace("os._exit(", f"{prelude}os._exit(")
    )


@LINUX
@pytest.mark.parametrize(("name", "is_there"), [("set_limits", True), ("moved_elsewhere", False)])
def test_what_is_not_there_cannot_be_taken_away(
    student: Student, monkeypatch: pytest.MonkeyPatch, name: str, is_there: bool
) -> None:
    """Else a defence that has moved would stay in force, and its test would say nothing of it."""
    file = student("def f(): return 1\n")
    without(monkeypatch, taking_away(f"confinement.{name}", "lambda *anything: None"))
    outcome = nullcontext() if is_there else pytest.raises(StudentCodeError, match=r"exited with os\._exit")
    with outcome, StudentFunctions(file, limits=QUICK) as functions:
        assert functions.call_batch("f", [{}]) == [1.0]


@pytest.mark.long
@LINUX
@pytest.mark.parametrize(
    ("body", "limits"),
    [
        ("x = bytearray(400 << 20); return 1", replace(QUICK, memory=300 * MIB, reply_s=10)),
        (
            "until = time.process_time() + 1.6\n    while time.process_time() < until: pass\n    return 1",
            replace(QUICK, cpu_s=1, reply_s=20),
        ),
    ],
    ids=["memory", "time"],
)
def test_a_limit_is_exceeded_where_it_is_not_set(
    student: Student, monkeypatch: pytest.MonkeyPatch, body: str, limits: Limits
) -> None:
    file = student(f"import time\ndef f():\n    {body}\n")
    with StudentFunctions(file, limits=limits) as functions, pytest.raises(StudentCodeError):
        functions.call_batch("f", [{}])
    without(monkeypatch, NO_LIMITS)
    with StudentFunctions(file, limits=limits) as functions:
        assert functions.call_batch("f", [{}]) == [1.0]


@pytest.mark.long
@LINUX
def test_a_daemon_is_left_behind_where_nobody_ends_it(
    student: Student, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    without(monkeypatch, taking_away("supervisor.end_descendants", "lambda *processes: None"))
    before = set(descendants(os.getpid()))
    marker = f"daemon-of-{tmp_path}"
    try:
        with pytest.raises(AssertionError):
            test_process.test_a_daemon_is_not_left_behind(student, tmp_path)
    finally:
        for found in Path("/proc").glob("[0-9]*/cmdline"):
            with suppress(OSError):
                if marker.encode() in found.read_bytes() and int(found.parent.name) not in before:
                    os.kill(int(found.parent.name), signal.SIGKILL)


def test_the_kits_environment_is_inherited_where_it_is_not_replaced(
    student: Student, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(process, "process_environment", lambda scratch: {**os.environ, "HOME": scratch})
    with pytest.raises(StudentCodeError, match="py:4: AssertionError"):  # the line that looks for it
        test_process.test_nothing_of_ours_is_in_its_surroundings(student, monkeypatch)


@LINUX
def test_solutions_can_be_read_where_they_are_not_hidden(
    student: Student, monkeypatch: pytest.MonkeyPatch
) -> None:
    if not is_level_available(Level.FILTERED):
        pytest.skip("not on this machine")
    solution = next((Path(__file__).parents[2] / "solutions").rglob("solution.py"))
    file = student(
        f"def f():\n    try: return len(open({str(solution)!r}).read())\n    except OSError: return 0\n"
    )
    gained = []
    for hides in (True, False):
        if not hides:
            monkeypatch.setattr(grants, "_hidden_paths", list)
            monkeypatch.setattr(grants, "_last_installed", None)
            monkeypatch.syspath_prepend(str(Path(__file__).parents[3]))
            monkeypatch.setattr(grants, "library_folders", lambda: [str(Path(__file__).parents[3])])
        with StudentFunctions(file, limits=QUICK, level=Level.FILTERED) as functions:
            gained.append(functions.call_batch("f", [{}])[0] > 0)
    assert gained == [False, True]


@pytest.mark.long
@LINUX
def test_files_that_nobody_sees_fill_a_disk_that_is_not_their_own(
    student: Student, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At level 1 where the kit may not mount: the table says so."""
    if not can_mount_scratch():
        pytest.skip("at level 1 this machine only measures")
    file = student(
        """
        import mmap, os
        kept = []
        def fill():
            try:
                for _ in range(20):
                    with open("x", "w+b") as file:
                        file.write(bytes(1 << 20)); file.flush()
                        kept.append(mmap.mmap(file.fileno(), 4096))
                        os.unlink("x")
            except OSError: pass
            return len(kept)
        """
    )
    limits, filled = replace(QUICK, scratch=8 * MIB, open_files=200), []
    for _ in range(2):
        with StudentFunctions(file, limits=limits, level=Level.FILTERED) as functions:
            filled += functions.call_batch("fill", [{}])
        without(monkeypatch, "confinement.namespaces.mount_scratch = lambda *folder: False; ")
    assert filled[0] <= 8
    assert filled[1] == 20


def test_a_calculation_goes_on_where_no_clock_looks(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(SubmissionClock, "check", lambda clock: None)
    with pytest.raises(pytest.fail.Exception, match="DID NOT RAISE"):
        test_returned_numbers.test_a_calculation_ends_with_the_submissions_time(0.0, tmp_path)


@LINUX
@pytest.mark.parametrize("kind", ["functions", "ended"])
def test_a_frame_at_the_wrong_time_is_taken_where_no_table_says_when(
    speaks: Callable[..., process.StudentProcess], monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    any_frame = dict.fromkeys(protocol.ProcessState, object)
    monkeypatch.setattr(protocol, "ALLOWED_FRAMES", any_frame)
    with pytest.raises((AssertionError, AttributeError)):
        test_states.test_every_frame_in_every_state(speaks, kind, protocol.ProcessState.CALLING_BATCH)


def test_words_come_after_a_secret_run_where_the_public_ones_do_not_come_first(
    function_assignment: Assignment, monkeypatch: pytest.MonkeyPatch
) -> None:
    def judge() -> None:
        test_secrets.test_nothing_that_a_student_reads_of_is_run_after_a_secret_run(
            function_assignment, Level.FILTERED, True, True, ["public", "counterpart 1", "secret"]
        )

    judge()
    monkeypatch.setattr(EvidenceScores, "_run_public", lambda scores: None)
    with pytest.raises(AssertionError):
        judge()


@pytest.mark.long
@LINUX
def test_runs_have_the_kits_user_and_its_threads_where_they_get_none_of_their_own(
    student: Student, monkeypatch: pytest.MonkeyPatch
) -> None:
    if not is_level_available(Level.ANOTHER_USER):
        pytest.skip("not on this machine")
    with monkeypatch.context() as patch:
        without(patch, taking_away("confinement.switch_user", "lambda *whose: None"))
        with pytest.raises((AssertionError, StudentCodeError)):
            test_confinement.test_two_runs_have_two_users(student, Level.ANOTHER_USER)
    without_groups(monkeypatch)
    without(monkeypatch, NO_LIMITS)
    with pytest.raises(AssertionError, match=r"f\(\) must return"):  # and so all thousand were started
        test_confinement.test_threads_are_counted(student, Level.ANOTHER_USER)


SEEN_BROKEN: Final[Mapping[str, Callable[..., Any]]] = MappingProxyType(
    {
        "outlive": test_a_daemon_is_left_behind_where_nobody_ends_it,
        "time": test_a_limit_is_exceeded_where_it_is_not_set,
        "memory": test_a_limit_is_exceeded_where_it_is_not_set,
        "inherit": test_the_kits_environment_is_inherited_where_it_is_not_replaced,
        "solutions": test_solutions_can_be_read_where_they_are_not_hidden,
        "disk": test_files_that_nobody_sees_fill_a_disk_that_is_not_their_own,
        "stat": test_what_a_level_prevents_and_what_it_does_not,
        "list": test_what_a_level_prevents_and_what_it_does_not,
        "access times": test_reading_leaves_no_trace_for_a_later_program,
        "numbers": test_a_calculation_goes_on_where_no_clock_looks,
        "frames": test_a_frame_at_the_wrong_time_is_taken_where_no_table_says_when,
        "order": test_words_come_after_a_secret_run_where_the_public_ones_do_not_come_first,
        "threads": test_runs_have_the_kits_user_and_its_threads_where_they_get_none_of_their_own,
        "user": test_runs_have_the_kits_user_and_its_threads_where_they_get_none_of_their_own,
    }
)
"""By promise that is not in ``WITHOUT_DEFENCE``: the test in which it is broken where its defence is missing."""


def test_every_promise_is_seen_broken_without_its_defence() -> None:
    assert set(WITHOUT_DEFENCE) == set(test_confinement.ATTACKS_BY_PROMISE)
    kept = {promise.key for promise in PROMISES if promise.since is not None}
    assert {*WITHOUT_DEFENCE, *SEEN_BROKEN} == kept


if __name__ == "__main__":
    before, _, rest = SECURITY.read_text(encoding="utf-8").partition(BEGIN)
    SECURITY.write_text(before + BEGIN + markdown_table() + END + rest.partition(END)[2], encoding="utf-8")
