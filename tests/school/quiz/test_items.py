"""Sheets with mistakes: every one is told, with its place."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
import yaml

from kit.school.quiz.items import QuizTopic, read_bank
from kit.world.problems import WorldError

Mapped = dict[str, object]


def good(name: str = "one") -> Mapped:
    return {
        "id": name,
        "topic": "layers",
        "question": "Which?",
        "options": [
            {"text": f"{name} {i}", "feedback": f"since {i}", **({"right": True} if i == 1 else {})}
            for i in range(3)
        ],
    }


def write(folder: Path, *items: Mapped, lesson: str = "01-first") -> Path:
    (folder / lesson).mkdir(exist_ok=True)
    (folder / lesson / "quiz.yaml").write_text(yaml.safe_dump({"items": list(items)}, sort_keys=False))
    return folder


def mistakes(folder: Path) -> str:
    with pytest.raises(WorldError) as caught:
        read_bank(folder)
    return str(caught.value)


def test_a_sheet_becomes_items(tmp_path: Path) -> None:
    item = {**good(), "picture": "a - b\n", "try": "kit maps", "derived": "it", "idea": 3}
    write(tmp_path, item)
    (read,) = read_bank(tmp_path).items
    assert (read.id, read.lesson, read.topic, read.idea) == ("one", "01-first", QuizTopic.LAYERS, 3)
    assert (read.right_option, read.picture, read.command_to_try, read.derivation) == (
        1,
        ("a - b",),
        "kit maps",
        "it",
    )
    assert read.lesson_to_repeat == "01-first"
    assert read.options[1].feedback == "since 1"


def _set(key: str, value: object) -> Callable[[Mapped], None]:
    return lambda item: item.__setitem__(key, value)


def _options(change: Callable[[list[Mapped]], object]) -> Callable[[Mapped], None]:
    return lambda item: change(item["options"]) and None  # type: ignore[arg-type, func-returns-value]  # a lambda


@pytest.mark.parametrize(
    ("spoil", "told"),
    [
        (_set("id", "No Id"), "small letters"),
        (_set("topic", "layer"), 'did you mean "layers"?'),
        (_set("idea", 13), "at most 12"),
        (_set("see", "02-second"), "no lesson"),
        (_set("see", "01-first/three"), "LESSON/STEP"),
        (_set("try", "rm -r x"), "a command of the kit"),
        (_set("picture", "é"), "ASCII"),
        (_set("picture", "x\n" * 9), "8 rows"),
        (_set("picture", "x" * 75), "74 columns"),
        (_set("questoin", "x"), "unknown key"),
        (_options(lambda options: options.pop()), "exactly 3"),
        (_options(lambda options: options[0].update(right=True)), "exactly one option"),
        (_options(lambda options: options[1].pop("right")), "exactly one option"),
        (_options(lambda options: options[0].update(text="ONE 1")), "say the same"),
        (_options(lambda options: options[0].pop("feedback")), '"feedback" is missing'),
    ],
)
def test_a_mistake_is_reported_with_its_location(
    spoil: Callable[[Mapped], None], told: str, tmp_path: Path
) -> None:
    item = good()
    spoil(item)
    said = mistakes(write(tmp_path, item))
    assert told in said
    assert "quiz.yaml:" in said


def test_all_mistakes_of_all_sheets_come_at_once(tmp_path: Path) -> None:
    write(tmp_path, {**good(), "topic": "x"})
    write(tmp_path, {**good("two"), "idea": 0}, lesson="02-second")
    said = mistakes(tmp_path)
    assert "01-first" in said
    assert "02-second" in said


def test_ids_and_ideas_are_of_one_item_each(tmp_path: Path) -> None:
    write(tmp_path, {**good(), "idea": 1}, {**good("two"), "idea": 1})
    write(tmp_path, good(), lesson="02-second")
    said = mistakes(tmp_path)
    assert 'an item "one" is already in' in said
    assert "an item of idea 1 is already in" in said
