from __future__ import annotations

import errno
import io
import multiprocessing
import os
import re
import tracemalloc
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.events import (
    Evaluated,
    EventReader,
    EventWriter,
    TrainingEnded,
    TrainingNote,
    TrainingProgress,
    TrainingStarted,
    decode_event,
    encode_event,
)
from kit.learning.training.run_config import RunConfig, RunError
from kit.learning.training.run_folders import create_run, find_run, left_out, list_runs
from kit.learning.training.runs import TrainingRun
from kit.learning.training.training_summary import summarise_events
from tests.cases import every_case

CONFIG = RunConfig(TaskSpec("turn"), "q-learning", seed=3)
RUN_PARTS = (
    "config.json", "events.jsonl", "control", "lock", "log.txt", "newest.npz", "best.npz", "checkpoint.zip",
    "checkpoint.old.zip", "sweep.jsonl", "theirs.py", "tensorboard/training_0",
)  # fmt: skip
EVENTS = (
    TrainingStarted(1.5, 0, {"numpy": "2"}),
    TrainingProgress(100, 0.5, 200.0, {"a": [1, 2, 3]}, -1.0, 20.0, {"reached": 2.0}, None),
    Evaluated(100, 0.6, {"a": [9, 1, 0]}, True, 3.0),
    Evaluated(200, 0.9, {"a": [5, 5, 0]}, False, 3.0, "why"),
    TrainingNote("so"),
    TrainingEnded("finished", 200, 1.0, "sure"),
)


@every_case("event", EVENTS, ids=lambda event: type(event).__name__)
def test_events_come_back_from_their_lines(event: object) -> None:
    line = encode_event(event)  # type: ignore[arg-type]  # one of the kinds
    assert b"\n" not in line
    assert decode_event(line) == event
    for wrong in (line[:-5], b"[]", b"null", b'{"event": "later"}', b'{"event": "noted"}', b"\xff"):
        assert decode_event(wrong) is None


def test_a_reader_gets_each_event_once_and_no_half_lines(tmp_path: Path) -> None:
    file = tmp_path / "events.jsonl"
    reader = EventReader(file)
    assert list(reader.read_new()) == []
    lines = b"".join(encode_event(event) + b"\n" for event in EVENTS)
    found = []
    for end in range(0, len(lines) + 1, 7):
        file.write_bytes(lines[:end])
        found += reader.read_new()
    file.write_bytes(lines)
    found += reader.read_new()
    assert tuple(found) == EVENTS
    assert list(EventReader(file, from_now=True).read_new()) == []


def test_a_writer_cuts_off_what_a_killed_one_left(tmp_path: Path) -> None:
    file = tmp_path / "events.jsonl"
    file.write_bytes(encode_event(EVENTS[0]) + b"\n" + encode_event(EVENTS[1])[:-8])
    with EventWriter(file) as writer:
        writer.write(EVENTS[2])
    assert tuple(EventReader(file).read_new()) == (EVENTS[0], EVENTS[2])


def test_a_full_disk_leaves_no_half_event(tmp_path: Path) -> None:
    """/dev/full takes nothing; the line that did not fit is not in the file afterwards."""
    file = tmp_path / "events.jsonl"
    with EventWriter(file) as writer:
        writer.write(EVENTS[0])
        limited = multiprocessing.get_context("fork").Process(target=_write_too_much, args=(file,))
        limited.start()
        limited.join()
    assert limited.exitcode == 0
    assert tuple(EventReader(file).read_new()) == (EVENTS[0],)


def _write_too_much(file: Path) -> None:
    import resource
    import signal

    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (file.stat().st_size + 10, resource.RLIM_INFINITY))
    writer = EventWriter(file)
    try:
        writer.write(EVENTS[1])
    except OSError as error:
        raise SystemExit(0 if error.errno == errno.EFBIG else 2) from None
    raise SystemExit(3)


def test_where_a_run_stands_follows_from_its_events() -> None:
    def state(count: int, alive: bool = False, order: str = "go") -> str:
        return summarise_events(EVENTS[:count], alive=alive, order=order).state  # type: ignore[arg-type]  # an Order

    assert state(0) == "new"
    assert state(2) == "interrupted"
    assert state(2, alive=True) == "running"
    assert state(2, alive=True, order="pause") == "paused"
    assert state(6) == "finished"
    summary = summarise_events(EVENTS, alive=False, order="go")
    assert (summary.best_evaluation, summary.last_evaluation, summary.steps) == (EVENTS[2], EVENTS[3], 200)
    assert list(summary.as_dict()) == [
        "state",
        "steps",
        "seconds",
        "rate",
        "last_evaluation",
        "best_evaluation",
        "reason",
        "measures",
    ]
    assert summarise_events((*EVENTS, EVENTS[0]), alive=False, order="go").state == "interrupted"


def test_a_run_is_found_by_name_and_the_last_without(tmp_path: Path) -> None:
    with pytest.raises(RunError, match="kit train turn"):
        find_run(tmp_path)
    first, second = create_run(tmp_path, CONFIG), create_run(tmp_path, CONFIG)
    assert first.name != second.name
    assert {run.name for run in list_runs(tmp_path)} == {first.name, second.name}
    assert find_run(tmp_path, first.name) == first
    assert first.config() == CONFIG
    with pytest.raises(RunError, match=first.name):
        find_run(tmp_path, first.name[:-1])
    with pytest.raises(RunError, match=f"--resume {first.name}"):
        create_run(tmp_path, CONFIG, first.name)


@pytest.mark.parametrize("name", ["", "../x", "a b", "-x", ".hidden", "x" * 200])
def test_a_name_that_is_none_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(RunError, match="letters"):
        create_run(tmp_path, CONFIG, name)
    assert not list(tmp_path.iterdir())


def test_a_damaged_configuration_is_named(tmp_path: Path) -> None:
    run = create_run(tmp_path, CONFIG)
    for text in ("{", "[]", '{"choice": {"task": "turn"}, "more": 1}', "null"):
        (run.folder / "config.json").write_text(text)
        with pytest.raises(RunError, match=r"config\.json"):
            run.config()
    with pytest.raises(RunError, match="not a run"):
        TrainingRun(tmp_path / "none").config()


def test_orders_arrive_and_nonsense_does_not(tmp_path: Path) -> None:
    run = TrainingRun(tmp_path)
    assert run.read_command() == "go"
    run.send_command("pause")
    assert run.read_command() == "pause"
    (tmp_path / "control").write_bytes(b"\xff\xfe")
    assert run.read_command() == "go"


def test_two_cannot_train_one_run(tmp_path: Path) -> None:
    run = TrainingRun(tmp_path)
    assert not run.is_active
    with run.lock():
        assert run.is_active
        with pytest.raises(RunError, match="already"), run.lock():
            pass
    assert not run.is_active


def test_the_older_checkpoint_stands_in_for_a_damaged_one(tmp_path: Path) -> None:
    run = TrainingRun(tmp_path)
    assert run.load_checkpoint() is None
    run.save_checkpoint({"a": b"1"})
    run.save_checkpoint({"a": b"2"})
    assert run.load_checkpoint() == ({"a": b"2"}, "")
    newer, older = run.checkpoints
    newer.write_bytes(newer.read_bytes()[:-30])
    loaded = run.load_checkpoint()
    assert loaded is not None
    assert loaded[0] == {"a": b"1"}
    assert newer.name in loaded[1]
    older.write_bytes(b"")
    with pytest.raises(RunError, match="start a new run"):
        run.load_checkpoint()


def test_a_kill_between_two_checkpoints_leaves_one(tmp_path: Path) -> None:
    run = TrainingRun(tmp_path)
    run.save_checkpoint({"a": b"1"})
    newer, older = run.checkpoints
    newer.replace(older)
    assert run.load_checkpoint() == ({"a": b"1"}, "")


def test_a_flipped_bit_is_noticed(tmp_path: Path) -> None:
    run = TrainingRun(tmp_path)
    run.save_checkpoint({"a": b"x" * 1000})
    data = bytearray(run.checkpoints[0].read_bytes())
    data[500] ^= 1
    run.checkpoints[0].write_bytes(data)
    assert zipfile.is_zipfile(run.checkpoints[0])
    with pytest.raises(RunError, match="damaged"):
        run.load_checkpoint()


def test_a_run_without_a_policy_says_so(tmp_path: Path) -> None:
    with pytest.raises(RunError, match="no policy yet"):
        TrainingRun(tmp_path).policy()


def array_bomb() -> bytes:
    """An archive of arrays whose header says that it has a petabyte of numbers."""
    part = io.BytesIO()
    np.lib.format.write_array_header_1_0(part, {"descr": "<f8", "fortran_order": False, "shape": (1 << 47,)})
    return zipped({"arr_0.npy": part.getvalue()}, zipfile.ZIP_STORED)


def zipped(parts: Mapping[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", method) as archive:
        for name, data in parts.items():
            archive.writestr(name, data)
    return packed.getvalue()


@every_case(
    "make",
    [
        lambda: zipped({"learner.json": b"0" * (1 << 24)}),
        lambda: zipped({"parameters.npz": zipped({"data.npy": b"0" * (1 << 24)})}, zipfile.ZIP_STORED),
        lambda: zipped({"replay.npz": zipped({"arr_0.npy": b"0" * (1 << 24)})}, zipfile.ZIP_STORED),
        lambda: zipped({"replay.npz": array_bomb()}, zipfile.ZIP_STORED),
        lambda: zipped({str(number): b"" for number in range(2000)}, zipfile.ZIP_STORED),
    ],
)
def test_a_checkpoint_of_somebody_elses_unpacks_to_no_more_than_it_is(
    make: Callable[[], bytes], tmp_path: Path
) -> None:
    run = TrainingRun(tmp_path)
    run.checkpoints[0].write_bytes(make())
    tracemalloc.start()
    with pytest.raises(RunError, match="damaged"):
        run.load_checkpoint()
    assert tracemalloc.get_traced_memory()[1] < 1 << 23
    tracemalloc.stop()


def test_a_named_pipe_is_no_checkpoint(tmp_path: Path) -> None:
    run = TrainingRun(tmp_path)
    os.mkfifo(run.checkpoints[0])
    with pytest.raises(RunError, match="damaged"):
        run.load_checkpoint()


@every_case(("part", "kind"), [(part, kind) for part in RUN_PARTS for kind in ("link", "pipe")])
def test_a_run_of_somebody_elses_leads_to_no_file_of_ones_own_and_holds_nobody(
    part: str, kind: str, tmp_path: Path
) -> None:
    own, runs = tmp_path / "own.txt", tmp_path / part.replace("/", "-") / kind
    own.write_text("mine")
    runs.mkdir(parents=True)
    run = create_run(runs, CONFIG, "theirs")
    file = run.folder / part
    file.parent.mkdir(exist_ok=True)
    file.unlink(missing_ok=True)
    if kind == "link":
        file.symlink_to(own)
    else:
        os.mkfifo(file)
    create_run(runs, CONFIG, "mine")
    assert [each.name for each in list_runs(runs)] == ["mine"]
    assert find_run(runs, "mine").config() == CONFIG
    with pytest.raises(RunError, match=re.escape(part)):
        find_run(runs, "theirs")
    assert [part in line for line in left_out(runs)] == [True]
    assert own.read_text() == "mine"


def test_a_run_whose_folder_lies_elsewhere_is_read(tmp_path: Path) -> None:
    (tmp_path / "large_disk").mkdir()
    (tmp_path / "runs").mkdir()
    run = create_run(tmp_path / "large_disk", CONFIG, "mine")
    (tmp_path / "runs" / "mine").symlink_to(run.folder)
    assert find_run(tmp_path / "runs", "mine").config() == CONFIG


def test_a_log_without_end_is_read_at_its_end_and_such_a_configuration_is_none(tmp_path: Path) -> None:
    run = create_run(tmp_path, CONFIG, "theirs")
    for name, text in (("log.txt", b"\nthe last\n"), ("config.json", b"{}")):
        with (run.folder / name).open("wb") as file:
            file.truncate(1 << 40)  # a file of holes
            file.seek(0, os.SEEK_END)
            file.write(text)
    assert run.last_log_line == "the last"
    with pytest.raises(RunError, match="damaged"):
        run.config()


def test_a_run_of_more_worlds_than_any_memory_holds_is_refused(tmp_path: Path) -> None:
    run = create_run(tmp_path, replace(CONFIG, worlds=100_000), "theirs")
    assert run.config().worlds == 100_000
    file = run.folder / "config.json"
    file.write_text(file.read_text().replace("100000", "1000000000"))
    with pytest.raises(RunError, match="1000000000 worlds"):
        run.config()
