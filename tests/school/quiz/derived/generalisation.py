"""What the questions on generalisation ask, worked out by the references of its exercises."""

from __future__ import annotations

from pathlib import Path

from kit.school.lessons.reading import lessons_folder
from kit.school.quiz.items import QuizItem
from tests.kit_content import lesson_reference
from tests.school.quiz.derived.finding import Derivation, Finding, nearest

LESSON = lessons_folder() / "25-generalisation"


def best_worst_case(item: QuizItem, folder: Path) -> Finding:
    table = [[1.00, 0.75, 0.95], [0.40, 0.70, 0.60]]
    names = ["Training A", "Training B", "Training C"]
    chosen = lesson_reference(LESSON.name, "crosstable").choose(table)
    return Finding(names[chosen], {name: name for name in names})


def mirrored_action(item: QuizItem, folder: Path) -> Finding:
    """Of one step, paid 0.2, in which the robot turned left."""
    doubled = lesson_reference(LESSON.name, "mirror").doubled
    _, (_, action, reward, _) = doubled([[[1.0, 2.0], 1, 0.2, [1.0, 2.0]]])
    found = ({1: "left", 2: "right"}[action], reward)
    return Finding(
        found,
        {
            'It becomes "turn right", paid 0.2': ("right", 0.2),
            'It becomes "turn right", paid -0.2': ("right", -0.2),
            'It stays "turn left", paid 0.2': ("left", 0.2),
        },
    )


def gap_of_a_training(item: QuizItem, folder: Path) -> Finding:
    gap = lesson_reference(LESSON.name, "crosstable").gap
    return nearest(item, gap([[0.90], [0.30], [0.50]], 0, [0]), 0.001)


GENERALISATION: dict[str, Derivation] = {
    "best-worst-case": best_worst_case,
    "mirrored-action": mirrored_action,
    "gap-of-a-training": gap_of_a_training,
}
