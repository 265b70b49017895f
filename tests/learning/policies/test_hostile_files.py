"""Models and policies that somebody made to harm who opens them: nothing runs, no memory is taken, each is refused in a sentence."""

from __future__ import annotations

import io
import json
import pickle
import struct
import tracemalloc
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

import kit
from kit.cli import main
from kit.host.sandbox.probe import highest_level_up_to
from kit.host.sandbox.sandbox_config import Level
from kit.learning.policies.policy import PolicyError
from kit.learning.policies.policy_file import policy_bytes
from kit.learning.policies.torch_weights import read_torch_weights
from tests.cases import every_case
from tests.learning.policies.test_policy import made, table

MOST_MB = 100
"""Memory that the reading of any of these files may take."""


class Pickled:
    """Writes the operations of a pickle that ``torch.save`` writes, and others."""

    def __init__(self) -> None:
        self.code = b"\x80\x02}"

    def tensor(
        self, name: str, shape: tuple[int, ...], strides: tuple[int, ...], kind: str = "Float", key: str = "0"
    ) -> Pickled:
        storage = (
            b"("
            + _text("storage")
            + f"ctorch\n{kind}Storage\n".encode()
            + _text(key)
            + _text("cpu")
            + _number(1)
            + b"tQ"
        )
        sizes = b"".join(b"(" + b"".join(map(_number, each)) + b"t" for each in (shape, strides))
        self.code += (
            _text(name)
            + b"ctorch._utils\n_rebuild_tensor_v2\n("
            + storage
            + _number(0)
            + sizes
            + b"\x89"
            + b"N"
            + b"tR"
            + b"s"
        )
        return self

    def bytes(self) -> bytes:
        return self.code + b"."


def _text(text: str) -> bytes:
    return b"X" + struct.pack("<I", len(text.encode())) + text.encode()


def _number(number: int) -> bytes:
    return b"J" + struct.pack("<i", number)


def saved_by_torch(pickled: bytes, numbers: Mapping[str, bytes]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr("policy/data.pkl", pickled)
        for key, data in numbers.items():
            archive.writestr(f"policy/data/{key}", data)
    return buffer.getvalue()


ZEROS = {"0": bytes(4 * 27)}
GOOD = Pickled().tensor("q_net.q_net.0.weight", (3, 9), (9, 1)).bytes()
"""The smallest network for the task ``turn``."""


def model(
    pickled: bytes = GOOD, about: str = '{"num_timesteps": 5}', numbers: Mapping[str, bytes] = ZEROS
) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr("data", about)
        archive.writestr("policy.pth", saved_by_torch(pickled, numbers))
    return buffer.getvalue()


def test_the_model_that_the_others_are_made_from_is_read(tmp_path: Path) -> None:
    (tmp_path / "model.zip").write_bytes(model())
    assert kit.load_policy(tmp_path / "model.zip", "turn").steps == 5


def alone(operations: bytes) -> bytes:
    return b"\x80\x02" + operations + b"."


def shared() -> bytes:
    many = Pickled()
    for number in range(70):
        many.tensor(f"x{number}", (1_000_000,), (1,), "Byte")
    return many.bytes()


def twice() -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, data in (("data", "{}"), ("policy.pth", "x"), ("policy.pth", saved_by_torch(GOOD, ZEROS))):
            archive.writestr(name, data)
    return buffer.getvalue()


def squeezed(member: str, content: bytes) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in {"data": b"{}", "policy.pth": saved_by_torch(GOOD, ZEROS), member: content}.items():
            archive.writestr(name, data)
    return buffer.getvalue()


def weight(shape: tuple[int, ...], strides: tuple[int, ...], kind: str = "Float") -> bytes:
    return model(Pickled().tensor("q_net.q_net.0.weight", shape, strides, kind).bytes())


MODELS: Mapping[str, Callable[[], bytes]] = {
    "memory asked for by a call": lambda: model(alone(b"cbuiltins\nbytearray\n" + _number(2_000_000_000) + b"\x85R")),
    "a tensor of nothing": lambda: model(alone(b"ctorch\nTensor\n" + _number(40_000) * 2 + b"\x86R")),
    "a place far away": lambda: model(alone(b"K\x01r" + struct.pack("<I", 0xFFFFFFF0))),
    "a long array of bytes": lambda: model(alone(b"\x96" + struct.pack("<Q", 1 << 40))),
    "a nested name": lambda: model(alone(b"})" + b"\x85" * 90_000 + b"K\x01s")),
    "one number as very many": lambda: weight((200_000, 200_000), (0, 0)),
    "one number as many": lambda: weight((3, 9), (0, 0), "Double"),
    "more than is stored": lambda: weight((3, 90), (90, 1)),
    "behind what is stored": lambda: weight((3, 9), (90, 1)),
    "before what is stored": lambda: weight((3, 9), (-9, 1)),
    "the same numbers very often": lambda: model(shared(), numbers={"0": bytes(1_000_000)}),
    "a single number": lambda: weight((), ()),
    "three dimensions": lambda: weight((3, 3, 3), (9, 3, 1)),
    "no dimension of any size": lambda: weight((0, 9), (9, 1)),
    "complex numbers": lambda: weight((3, 9), (9, 1), "ComplexFloat"),
    "not a number": lambda: model(numbers={"0": np.full(27, np.nan, np.float32).tobytes()}),
    "too large for 4 bytes": lambda: model(
        Pickled().tensor("q_net.q_net.0.weight", (3, 9), (9, 1), "Double").bytes(), numbers={"0": np.full(27, 1e300).tobytes()}
    ),
    "a chance of any size": lambda: model(about=json.dumps({"exploration_rate": 10**400})),
    "a chance that is none": lambda: model(about='{"exploration_rate": NaN}'),
    "steps of any size": lambda: model(about=json.dumps({"num_timesteps": 10**4000})),
    "fewer steps than none": lambda: model(about='{"num_timesteps": -7}'),
    "a deep description": lambda: model(about="[" * 200_000),
    "a long number": lambda: model(about="9" * 1_000_000),
    "a description that unpacks": lambda: squeezed("data", b"[" + b"[]," * 3_000_000 + b"[]]"),
    "weights that unpack": lambda: squeezed("policy.pth", bytes(257 << 20)),
    "two of one name": twice,
    "escapes in a name": lambda: model(Pickled().tensor("\x1b[2J" * 1000, (3, 9), (9, 1)).bytes()),
    "escapes in a description": lambda: model(about=json.dumps({"policy_kwargs": {"activation_fn": "\x1b]0;x\x07" * 1000}})),
}  # fmt: skip


def refusal(file: Path, task: str | None) -> str:
    """What is said of a file that is refused, without its name; and checks that reading it took little memory."""
    tracemalloc.start()
    try:
        with pytest.raises(PolicyError) as refused:
            kit.load_policy(file, task)
        assert tracemalloc.get_traced_memory()[1] < MOST_MB << 20
    finally:
        tracemalloc.stop()
    return str(refused.value).replace(str(file), "")


def check_sentence(message: str) -> None:
    assert len(message) < 500
    assert message.replace("\n", "").isprintable()


@pytest.mark.filterwarnings("ignore:Duplicate name")
@every_case("name", MODELS)
def test_no_model_takes_memory_or_says_more_than_a_sentence(name: str, tmp_path: Path) -> None:
    (tmp_path / "model.zip").write_bytes(MODELS[name]())
    check_sentence(refusal(tmp_path / "model.zip", "turn"))


def test_what_torch_writes_of_a_view_is_read() -> None:
    numbers = np.arange(6, dtype=np.float64)
    code = Pickled().tensor("turned", (3, 2), (1, 3), "Double").bytes()
    found = read_torch_weights(saved_by_torch(code, {"0": numbers.tobytes()}))
    assert found["turned"].tolist() == [[0.0, 3.0], [1.0, 4.0], [2.0, 5.0]]


def test_numbers_of_which_many_tensors_are_views_are_read_once(monkeypatch: pytest.MonkeyPatch) -> None:
    torch = pytest.importorskip("torch")
    numbers, buffer, read = torch.arange(100.0), io.BytesIO(), list[str]()
    torch.save({f"w{at}": numbers[at : at + 1] for at in range(100)}, buffer)
    whole = zipfile.ZipFile.read
    monkeypatch.setattr(
        zipfile.ZipFile, "read", lambda archive, name: (read.append(name), whole(archive, name))[1]
    )
    found = read_torch_weights(buffer.getvalue())
    assert [found[f"w{at}"].item() for at in range(100)] == list(range(100))
    assert len(read) == len(set(read))


@every_case("name", ["network.pt", "network.pth"])
def test_of_parameters_alone_it_is_said_what_is_wanted(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / name).write_bytes(saved_by_torch(GOOD, ZEROS))
    result = CliRunner().invoke(main, ["evaluate", name, "--workspace", str(tmp_path)])
    assert result.exit_code == 2
    assert "model.save('model.zip')" in result.output


def test_a_pickle_of_python_runs_nothing(tmp_path: Path) -> None:
    class Spy:
        def __reduce__(self) -> tuple[Any, ...]:
            return Path.touch, (tmp_path / "ran",)

    with pytest.raises(ValueError, match=r"no tensor|no weights"):
        read_torch_weights(saved_by_torch(pickle.dumps(Spy(), 2), {}))
    assert not (tmp_path / "ran").exists()


def policy(about: Mapping[str, Any] | None = None, **arrays: np.ndarray[Any, Any]) -> bytes:
    """A table's file with other parts."""
    with np.load(io.BytesIO(policy_bytes(table()))) as stored:
        parts = {name: stored[name] for name in stored.files}
    said = json.loads(parts["about"].tobytes()) | (about or {})
    parts["about"] = np.frombuffer(json.dumps(said).encode(), np.uint8)
    buffer = io.BytesIO()
    np.savez(buffer, allow_pickle=False, **(parts | arrays))
    return buffer.getvalue()


POLICIES: Mapping[str, Callable[[], bytes]] = {
    "one input very often": lambda: policy(
        used=np.zeros(1_900_000, np.int8), edges=np.zeros(0, np.float32), values=np.zeros((1, 3), np.float32)
    ),
    "a power that never ends": lambda: policy(used=np.zeros(1_000_000, np.int8), edges=np.arange(200_000, dtype=np.float32)),
    "inputs of any size": lambda: policy({"inputs": 10**4000}),
    "steps of any size": lambda: policy({"steps": 10**4000}),
    "fewer steps than none": lambda: policy({"steps": -5}),
    "actions of any size": lambda: policy({"choices": [10**4000]}),
    "any file as its task": lambda: policy({"task": {"task": "/etc/passwd"}}),
    "escapes in its task": lambda: policy({"task": {"task": "\x1b[2J"}}),
}  # fmt: skip


def test_the_policy_that_the_others_are_made_from_is_read(tmp_path: Path) -> None:
    (tmp_path / "p.npz").write_bytes(policy())
    assert kit.load_policy(tmp_path / "p.npz").choices == (3,)


@every_case("name", POLICIES)
def test_no_policy_takes_memory_or_names_any_file(name: str, tmp_path: Path) -> None:
    (tmp_path / "p.npz").write_bytes(POLICIES[name]())
    check_sentence(refusal(tmp_path / "p.npz", None))


TASK = """
maps: [turn]
actions: {twists: {forward: [0.5, 0], left: [0, 1.57], right: [0, -1.57]}}
observation: {sectors: 9, clip: 2, scale: 0.5}
reward: {file: evil.py}
target: {radius: 0.2}
step: {time: 0.1, limit: 3}
"""
EVIL = "open({ran!r}, 'w')\ndef reward(to_go): return 0.0\ndef metric_all(to_go): return 1.0\n"


@pytest.mark.parametrize("has_task", [False, True])
def test_a_policy_names_no_program_that_runs_with_ones_rights(
    has_task: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if has_task and highest_level_up_to(Level.ANOTHER_USER) is Level.LIMITED:
        pytest.skip("this machine confines nothing")
    monkeypatch.chdir(tmp_path)
    ran = tmp_path / "ran"
    Path("evil.py").write_text(EVIL.format(ran=str(ran)))
    if has_task:
        Path("own.yaml").write_text(TASK)
    own = {"task": {"task": "own.yaml", "text": TASK}}
    with np.load(io.BytesIO(policy_bytes(made()))) as stored:
        parts = {name: stored[name] for name in stored.files}
    said = json.loads(parts["about"].tobytes()) | own | {"interface": {}}
    np.savez("p.npz", **(parts | {"about": np.frombuffer(json.dumps(said).encode(), np.uint8)}))
    told = CliRunner().invoke(main, ["evaluate", "p.npz", "--episodes", "2"])
    assert told.exit_code != 0
    assert ("evil.py:1" if has_task else "reward is not here") in told.output
    assert not ran.exists()
