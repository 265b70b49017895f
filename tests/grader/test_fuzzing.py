"""A small share of the inputs of ``python -m tests.grader.fuzzing``, other ones in every reader; and the command itself."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from tests.grader import fuzzing
from tests.grader.fuzzing import READERS, Reader, fuzz, mutated


@pytest.mark.parametrize("name", READERS)
def test_a_reader_stands_what_is_nearly_right(name: str) -> None:
    assert [what for _, what in fuzz(name, 60, seed=7)] == []


def test_mutations_change_what_is_handed_in_and_some_of_it_is_still_read() -> None:
    """An input that is always refused at its first byte would try nothing."""
    rng = random.Random(1)
    for name, reader in READERS.items():
        valid = reader.valid()[0]
        changed = [mutated(valid, rng) for _ in range(40)]
        assert len({valid, *changed}) > 20, name


def test_what_a_reader_does_not_stand_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def read(content: bytes, folder: Path) -> int:
        while content.startswith(b"\xff\xfe"):
            pass
        return int(content)

    monkeypatch.setattr(fuzzing, "SLOWEST_S", 0.05)
    monkeypatch.setitem(
        READERS, "numbers", Reader(lambda: [b"12 34 56".replace(b" ", b"")], read, (LookupError,))
    )
    found = [what for _, what in fuzz("numbers", 300, seed=1)]
    assert any("ValueError" in what for what in found)
    assert any("more than" in what for what in found)
