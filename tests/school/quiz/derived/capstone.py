"""What the last lesson's map, times and tests come to."""

from __future__ import annotations

from pathlib import Path

from kit.learning.policies.confidence_intervals import lower_bound
from kit.school.quiz.items import QuizItem
from tests.school.lessons.capstone_derivations import make_map, race_criterion
from tests.school.quiz.derived.finding import Derivation, Finding, nearest

NARROW = """\
#########
#S#######
# #######
#      T#
#########
"""


def narrow_course(item: QuizItem, folder: Path) -> Finding:
    said = make_map(NARROW, folder, "--cell", "0.1")
    return Finding(
        "refused" if "wide" in said else "made",
        {
            "It makes the map, and the robot gets stuck": "made",
            "It makes no map, and says how wide the way is": "refused",
            "It makes the passage wider by itself": "widened",
        },
    )


def shortest_time_of_a_course(item: QuizItem, folder: Path) -> Finding:
    return nearest(item, 6.0 / 0.4, 0.1)


def times_the_shortest(item: QuizItem, folder: Path) -> Finding:
    return Finding(
        "yes" if race_criterion("race").anchors.full >= 16.2 / 12 else "slow",
        {
            "No, for it takes 4.2 s more": "slow",
            "Only if it never turns": "turns",
            "Yes, for it takes 1.35 times as long": "yes",
        },
    )


def surely_nine_tenths(item: QuizItem, folder: Path) -> Finding:
    return Finding(
        "sure" if lower_bound(92, 100) >= race_criterion("test").anchors.full else "below",
        {
            "Yes, as 92 is more than 90": "sure",
            "No, its lower end is below 90": "below",
            "No, as one must test all cases": "all",
        },
    )


CAPSTONE: dict[str, Derivation] = {
    "narrow-course": narrow_course,
    "shortest-time-of-a-course": shortest_time_of_a_course,
    "times-the-shortest": times_the_shortest,
    "surely-nine-tenths": surely_nine_tenths,
}
