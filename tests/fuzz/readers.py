"""Fuzzes what is read from one file or one message: policies, exports, task files, assignments, workers' results, CDR."""

from __future__ import annotations

import json
import random
import shutil
import struct
import warnings
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any, Final, get_args

import numpy as np

from grader.cohort.gradebook import as_csv, as_json, gradebook_rows
from grader.cohort.queue import Queue, prepare_queue
from grader.grading import GradingOptions
from grader.kinds.policy.kind import load_submitted_policy
from grader.reading import read_assignment
from grader.reports import FORMATS
from kit.bridge.channels import WireCodec
from kit.document.markdown import document_to_markdown
from kit.host.failure import StudentCodeError
from kit.host.sandbox.sandbox_config import Level
from kit.learning.environment.batch import BatchEnv
from kit.learning.policies.policy import Policy, PolicyError
from kit.learning.policies.policy_file import load_policy, policy_bytes
from kit.learning.tasks.learning_task import UnknownTask
from kit.learning.tasks.task_reader import read_task
from kit.learning.tasks.task_spec import TaskSpec
from kit.msg.interfaces import find_interface, interface_names
from kit.msg.message import Message
from kit.msg.std_msgs import String
from kit.ros.bags import BagError, BagRecorder, Storage, read_bag, read_messages
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.school.form_reading import read_form
from kit.school.report.class_data import build_class_data, read_roster
from kit.school.report.class_report import build_report, prepare_report
from kit.world.problems import WorldError
from tests.fuzz.damage import Files, damage_bytes, damage_files, damage_json, nudge_json
from tests.fuzz.files import ROOT, clear, damaged_archive, members_of
from tests.grader.conftest import FORWARD, write_assignment
from tests.learning.policies.test_policy import made, table
from tests.school.report.class_builder import diaries, export_of


class PolicyTarget:
    """Damaged policies: loaded as a user and as the grader load them, and played."""

    def __init__(self, folder: Path) -> None:
        self._file = folder / "best.npz"
        policies = (made(), made(recurrent=True), table())
        self._members: Sequence[Files] = [members_of(policy_bytes(each)) for each in policies]
        self._task = TaskSpec("turn").resolve()

    def attempt(self, rng: random.Random) -> str:
        """Reads one policy."""
        self._file.write_bytes(damaged_archive(rng, rng.choice(self._members)))
        try:
            self._play(load_policy(self._file))
        except (PolicyError, UnknownTask, WorldError):
            return "loaded: refused"
        try:
            load_submitted_policy(self._file)
        except (PolicyError, StudentCodeError):
            return "played, but not taken by the grader"
        return "played"

    def _play(self, policy: Policy) -> None:
        policy.check_fits(self._task)
        seen = BatchEnv(self._task, 2, 1).reset()
        for chance in (None, np.random.default_rng(1)):
            actions = policy.make_player(2, chance).act(seen)
            assert ((actions >= 0) & (actions < policy.choices[0])).all()


class ExportTarget:
    """Damaged exports of students' progress: one of a class is read into the class report."""

    def __init__(self, folder: Path) -> None:
        self._folder = clear(folder / "class")
        self._exports = [export_of(diary.events) for diary in diaries(3)]
        for number, text in enumerate(self._exports):
            (self._folder / f"s{number}.json").write_text(text, encoding="utf-8")
        self._form = read_form()

    def attempt(self, rng: random.Random) -> str:
        """Reads one class."""
        content = self._damaged(rng, self._exports[0])
        (self._folder / "s0.json").write_bytes(content)
        roster = read_roster([self._folder])
        data = build_class_data(roster, self._form, {})
        if rng.random() < 0.03:
            assert document_to_markdown(build_report(prepare_report(data), roster.file_count)).strip()
        return f"{len(roster.students)} of 3"

    def _damaged(self, rng: random.Random, text: str) -> bytes:
        if rng.random() < 0.3:
            return damage_bytes(rng, {"export": text.encode()}, "export")
        change = rng.choice((damage_json, nudge_json))
        document = json.loads(text)
        events = document["events"]
        if rng.random() < 0.8:  # the meaning of a few entries
            for at in rng.sample(range(len(events)), rng.choice((1, 1, 5))):
                if rng.random() < 0.8:
                    events[at]["content"] = change(rng, events[at]["content"])
                else:
                    events[at] = change(rng, events[at])
        else:
            document = change(rng, document)
        return json.dumps(document).encode()


class TaskTarget:
    """Damaged task files of learners."""

    def __init__(self, folder: Path) -> None:
        self._file = folder / "task.yaml"
        self._tasks = [file.read_bytes() for file in sorted((ROOT / "kit/learning/tasks").glob("*.yaml"))]

    def attempt(self, rng: random.Random) -> str:
        """Reads one task."""
        files = damage_files(rng, {"task.yaml": rng.choice(self._tasks)})
        self._file.write_bytes(files["task.yaml"])
        try:
            read_task(self._file)
        except (UnknownTask, WorldError):
            return "refused"
        return "read"


class AssignmentTarget:
    """Damaged assignments, which a teacher has from somebody else."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder / "assignment"
        sheets = sorted(ROOT.glob("lessons/*/*/assignment.yaml"))[::5]
        self._folders = [sheet.parent for sheet in sheets]

    def attempt(self, rng: random.Random) -> str:
        """Reads one assignment."""
        shutil.rmtree(self._folder, ignore_errors=True)
        shutil.copytree(rng.choice(self._folders), self._folder)
        sheet = self._folder / "assignment.yaml"
        sheet.write_bytes(damage_files(rng, {sheet.name: sheet.read_bytes()})[sheet.name])
        try:
            read_assignment(self._folder)
        except WorldError:
            return "refused"
        return "read"


class ResultTarget:
    """Damaged results that the workers of a class have left, read into the gradebook and every kind of report."""

    def __init__(self, folder: Path) -> None:
        works = clear(folder / "in")
        (works / "a.py").write_text(FORWARD)
        self._queue = Queue(clear(folder / "queue"))
        options = GradingOptions(Level.LIMITED, may_lower_level=False)
        prepare_queue(self._queue, works, read_assignment(write_assignment(folder / "quick")), options)
        (self._key,) = self._queue.waiting()
        self._queue.record_loss(self._key)
        self._whole = self._queue.result_file(self._key).read_bytes()

    def attempt(self, rng: random.Random) -> str:
        """Reads one result."""
        if rng.random() < 0.3:
            content = damage_bytes(rng, {"result": self._whole}, "result")
        else:
            change = rng.choice((damage_json, nudge_json))
            content = json.dumps(change(rng, json.loads(self._whole))).encode()
        self._queue.result_file(self._key).write_bytes(content)
        rows = gradebook_rows(self._queue)
        assert as_csv(rows)
        assert as_json(rows)
        result = self._queue.result(self._key)
        if result is None:
            return "refused"
        for shown in (result, result.for_student()):
            for report_format in FORMATS.values():
                report_format.write(shown)
        return "read"


class BagTarget:
    """Damaged bags, of somebody else's robot, of both kinds of storage."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder / "bag"
        self._bags = []
        for storage in get_args(Storage):
            made = clear(folder / "made") / storage
            graph = Graph(log_sink=lambda record: None)
            publisher = create_graph_node(graph, "talker").create_publisher(String, "/chat", 10)
            with BagRecorder(graph, made, storage=storage) as recorder:
                for number in range(20):
                    publisher.publish(String(data=f"hello {number}"))
                    graph.run_due()
                    recorder.exchange()
            self._bags.append({file.name: file.read_bytes() for file in made.iterdir()})

    def attempt(self, rng: random.Random) -> str:
        """Reads one bag."""
        with warnings.catch_warnings(
            action="ignore"
        ):  # of the YAML library's, for an anchor that is there twice
            for name, content in damage_files(rng, rng.choice(self._bags)).items():
                (self._folder / name).parent.mkdir(exist_ok=True)
                (self._folder / name).write_bytes(content)
            try:
                read_bag(self._folder)
                count = sum(1 for _ in read_messages(self._folder))
            except BagError:
                return "refused"
            finally:
                shutil.rmtree(self._folder)
        return "read" if count else "read, empty"


MAX_RANDOM: Final = 200


class MessageTarget:
    """Damaged messages in CDR of every type, as a robot may send them."""

    def __init__(self, folder: Path) -> None:
        self._codec = WireCodec("jazzy")
        self._types = _message_types()

    def attempt(self, rng: random.Random) -> str:
        """Reads one message."""
        cls: Any = rng.choice(self._types)
        data = bytearray(self._codec.serialize(cls())) + rng.randbytes(rng.choice((0, 0, 9, MAX_RANDOM)))
        for _ in range(rng.choice((1, 1, 4))):
            at = 4 * rng.randrange(len(data) // 4 + 1)
            number = struct.pack("<I", rng.choice((0, 5, 10**6, 2**31 - 1, 2**31, 2**32 - 1)))
            data[at : at + 4] = rng.choice((number, rng.randbytes(4), b"", b"\xff"))
        try:
            message = self._codec.deserialize(bytes(data), cls)
        except ValueError:
            return "refused"
        assert self._codec.serialize(message)
        return "read"


@cache
def _message_types() -> Sequence[type[Message]]:
    codec = WireCodec("jazzy")
    found = []
    for name in interface_names():
        cls = find_interface(name)
        if issubclass(cls, Message):
            try:
                codec.serialize(cls())
            except ValueError:  # a type that cannot pass
                continue
            found.append(cls)
    return found
