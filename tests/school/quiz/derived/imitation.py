"""What copies of a teacher do, found out in the lesson's corridor; and what the kit says of recordings."""

from __future__ import annotations

from pathlib import Path

from kit.learning.training.controller_demonstrator import ControllerDemonstrator
from kit.learning.training.demonstrations import RecordedDemonstrator
from kit.school.quiz.items import QuizItem
from tests.kit_content import lesson_reference
from tests.school.lessons.imitation_derivations import GUSTS, calm_examples, reference
from tests.school.quiz.derived.finding import Derivation, Finding


def more_of_the_same_drives(item: QuizItem, folder: Path) -> Finding:
    one, ten = (reference().drive(calm_examples() * count, 0, GUSTS) for count in (1, 10))
    return Finding(
        "nothing" if one == ten else "more",
        {
            "It comes back from gusts": "back",
            "It comes back more often": "more",
            "Nothing changes at all": "nothing",
        },
    )


def action_from_a_recording(item: QuizItem, folder: Path) -> Finding:
    cloning = lesson_reference("26-imitation", "clone")
    found = cloning.examples([2, 1, 0, 0])
    return Finding(
        (len(found), found[0][1]),
        {
            "Three, and in row 2 the action -1": (3, -1),
            "Four, and in row 2 the action -1": (4, -1),
            "Three, and in row 2 the action 1": (3, 1),
        },
    )


def nearest_example(item: QuizItem, folder: Path) -> Finding:
    return Finding(
        reference().imitate([[0, 0], [3, -1]], 2),
        {"It goes straight on": 0, "It steers down by one row": -1, "It cannot act in row 2": None},
    )


def who_drives_in_dagger(item: QuizItem, folder: Path) -> Finding:
    """New examples are of the copy's rows, with the teacher's actions."""
    found = reference()
    known = calm_examples()
    new = found.dagger(known, 0, GUSTS, found.TEACHER, 1)[len(known) :]
    rows = [row for row in found.drive(known, 0, GUSTS) if abs(row) < found.WALL]
    driver = "copy" if [row for row, _ in new] == rows else "teacher"
    asked = "teacher" if all(action == found.TEACHER[row + 3] for row, action in new) else "copy"
    return Finding(
        (driver, asked),
        {
            "The teacher drives, and the copy is asked": ("teacher", "copy"),
            "The copy drives, and the teacher is asked": ("copy", "teacher"),
            "The teacher drives, and the teacher is asked": ("teacher", "teacher"),
        },
    )


def recording_in_dagger(item: QuizItem, folder: Path) -> Finding:
    """What the kit's own demonstrators say of themselves."""
    can_be_asked = RecordedDemonstrator.can_be_asked
    assert ControllerDemonstrator.can_be_asked
    return Finding(
        "both" if can_be_asked else "cloning",
        {"Behaviour cloning alone": "cloning", "DAgger alone": "dagger", "Both of them": "both"},
    )


IMITATION: dict[str, Derivation] = {
    "more-of-the-same-drives": more_of_the_same_drives,
    "action-from-a-recording": action_from_a_recording,
    "nearest-example": nearest_example,
    "who-drives-in-dagger": who_drives_in_dagger,
    "recording-in-dagger": recording_in_dagger,
}
