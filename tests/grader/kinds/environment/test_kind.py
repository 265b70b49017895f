"""Environments that are handed in: what is right and wrong in them, and what does not come back."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest

from grader.grading import GradingOptions, grade
from grader.kinds.environment.examination import sector_minima
from grader.reading import read_assignment
from grader.submission import Submission
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import CriterionStatus, GradingResult
from kit.world.problems import WorldError
from tests.grader.conftest import LOCKS
from tests.learning.worlds import NINE_NUMBERS

LESSON = Path(__file__).parents[4] / "lessons" / "10-words-of-learning" / "hallway"
GOOD = Path(__file__).parents[3] / "solutions" / "10-words-of-learning" / "hallway" / "solution.py"
ASSIGNMENT_TEXT = """
title: Short
kind: environment
submit: hallway_env.py
level: 0
environment:
  class: HallwayEnv
  place: turn
  case: turn_a_to_b
  moves: [[0.5, 0], [0, 1.57], [0, -1.57]]
  max_steps: 60
  way: [[0, 1.6], [1.6, 1.6]]
checks:
  - {check: spaces, points: 1}
  - {check: resets, points: 1}
  - {check: steps, points: 1}
  - {check: sees, points: 1}
  - {check: acts, points: 1}
  - {check: crash, points: 1}
  - {check: timeout, points: 1}
  - {check: repeats, points: 1}
budget: {start: 15, reply: 2.0}
"""
"""Sixty steps do not lead to the target."""
SHORT = ("MAX_STEPS = 200", "MAX_STEPS = 60")
DESK = GradingOptions(Level.LIMITED)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "short"
    made.mkdir()
    (made / "assignment.yaml").write_text(ASSIGNMENT_TEXT)
    return made


def graded(folder: Path, *changes: tuple[str, str], options: GradingOptions = DESK) -> GradingResult:
    source = GOOD.read_text()
    for old, new in (SHORT, *changes):
        assert old in source
        source = source.replace(old, new)
    return grade(
        read_assignment(folder),
        Submission("ada", "hallway_env.py", {"hallway_env.py": source.encode()}),
        options,
    )


def lost(result: GradingResult) -> set[str]:
    return {test.id for test in result.tests if test.status is not CriterionStatus.PASS}


@pytest.mark.long
@LOCKS
def test_a_good_one_earns_everything_locked_in(folder: Path) -> None:
    assert lost(graded(folder, options=GradingOptions(Level.FILTERED))) == set()


@pytest.mark.long
@LOCKS
def test_helpers_beside_it_come_along(folder: Path) -> None:
    """But none takes the examiner's place."""
    source = GOOD.read_text().replace("MAX_STEPS = 200", "from settings import MAX_STEPS")
    files = {
        "hallway_env.py": source.encode(),
        "settings.py": b"from more.numbers import MAX_STEPS\n",
        "more/numbers.py": b"MAX_STEPS = 60\n",
        "environment_examiner.py": b"raise SystemExit(1)\n",
    }
    result = grade(
        read_assignment(folder), Submission("ada", "hallway_env.py", files), GradingOptions(Level.FILTERED)
    )
    assert lost(result) == set()


@pytest.mark.long
def test_the_seed_of_the_grade_is_another_one(folder: Path) -> None:
    (folder / "secret.yaml").write_text("seed: 99\n")
    assert lost(graded(folder, options=GradingOptions(Level.LIMITED, secret=True))) == set()


@pytest.mark.long
@pytest.mark.parametrize(
    ("change", "checks", "word"),
    [
        (("Discrete(3)", "Discrete(4)"), {"spaces"}, "Discrete(3)"),
        (("shape=(9,), dtype=np.float32)", "shape=(9,), dtype=np.uint8)"), {"spaces", "resets", "steps"}, "dtype"),
        (("return self.observation(), {}\n\n    def step", "return self.observation()\n\n    def step"), {"resets"}, "two values"),
        (("dx, dy, self.np_random", "1 + dx, dy, self.np_random"), {"resets"}, "from its home"),
        (("self.robot.drive(*MOVES[action])", "self.robot.drive(*MOVES[0])"), {"acts", "timeout"}, "should drive"),
        (("def reset(", "def observation(self): return [2.0] * 9\n\n    def reset("), {"sees"}, "not a list"),
        (("self.steps = 0\n        return", "return"), {"crash"}, "count of steps"),
        (("self.steps += 1", "self.steps += 1; self.action_space = gymnasium.spaces.Discrete(3 + self.steps)"), {"spaces"}, "another one after step"),
        (("self.steps += 1", "self.steps += 1; self.observation_space.high[0] = self.steps"), {"spaces"}, "another one after step"),
    ],
    ids=["four actions", "bytes", "no info", "elsewhere", "one move", "a list", "never counts anew", "more actions", "wider"],
)  # fmt: skip
def test_a_mistake_loses_what_it_is_about(
    folder: Path, change: tuple[str, str], checks: set[str], word: str
) -> None:
    result = graded(folder, change)
    assert checks <= lost(result)
    assert any(word in test.rationale for test in result.tests if test.id in checks)


@pytest.mark.long_cases("loops", "waits without spinning")
@pytest.mark.parametrize(
    ("change", "status", "word"),
    [
        (("class HallwayEnv(gymnasium.Env)", "class HallEnv(gymnasium.Env)"), CriterionStatus.STUDENT_ERROR, "HallEnv"),
        (("class HallwayEnv(gymnasium.Env)", "class HallwayEnv"), CriterionStatus.STUDENT_ERROR, "gymnasium.Env"),
        (("self.steps += 1", "self.steps += 1 / 0"), CriterionStatus.STUDENT_ERROR, "hallway_env.py"),
        (("self.steps += 1", "import sys; sys.exit(0)"), CriterionStatus.STUDENT_ERROR, ""),
        (("self.steps += 1", "while True: pass"), CriterionStatus.TIMEOUT, "hallway_env.py"),
        (('"static_laser"', '"no_laser"'), CriterionStatus.TIMEOUT, "did not come back"),
        (("rclpy.spin_once(self)", "pass"), CriterionStatus.TIMEOUT, "hallway_env.py"),
        (("import math", "import math, os; os._exit(3)"), CriterionStatus.STUDENT_ERROR, ""),
    ],
    ids=["no class", "no env", "raises", "leaves", "loops", "waits for nobody", "waits without spinning", "dies"],
)  # fmt: skip
def test_what_does_not_come_back_is_told(
    folder: Path, change: tuple[str, str], status: CriterionStatus, word: str
) -> None:
    test = graded(folder, change).tests[0]
    assert test.status is status
    assert word in test.rationale
    assert "examiner" not in test.rationale
    assert "/tmp" not in test.rationale


def test_answers_that_are_forged_are_no_answers(folder: Path) -> None:
    drive = "        self.robot.drive(*MOVES[action])\n"
    forged = """        from std_msgs.msg import String
        answers = self.robot.create_publisher(String, '/examination/answer', 10)
        answers.publish(String(data='[' * 2000))
"""
    assert graded(folder, (drive, forged + drive)).tests[0].status is CriterionStatus.PROTOCOL_ERROR


@pytest.mark.long
def test_nothing_that_a_hostile_file_returns_breaks_the_grader(folder: Path) -> None:
    hostile = (
        "return self.observation(), reward, terminated, truncated, {}",
        "return np.full(9, np.nan), float('inf'), np.zeros(10**5), type('X' * 9999, (), {})(), [[[]]]",
    )
    result = graded(folder, hostile)
    assert {"steps", "sees", "crash", "timeout"} <= lost(result)
    assert all(test.status is not CriterionStatus.GRADER_ERROR for test in result.tests)


@pytest.mark.long
@pytest.mark.parametrize("value", ["10**400", "1j", "Odd([1])", "np.float64(1e300) * 1e300"])
def test_a_reward_that_is_no_number_is_told_in_the_words_of_the_task(folder: Path, value: str) -> None:
    odd = (
        "import math",
        "import math\n\n\nclass Odd(list):\n    def __getitem__(self, at):\n        raise KeyError\n",
    )
    change = ("return self.observation(), reward,", f"return self.observation(), {value},")
    result = graded(folder, odd, change)
    assert "steps" in lost(result)
    assert all(test.status is CriterionStatus.FAIL for test in result.tests if test.id == "steps")
    assert not any("finite_or_none" in test.rationale for test in result.tests)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("case: turn_a_to_b", "case: turn", "turn"),
        ("max_steps: 60", "max_steps: 5000", "at most"),
        ("way: [[0, 1.6], [1.6, 1.6]]", "way: [[0, 1.6, 3]]", "point"),
        ("class: HallwayEnv", "klass: HallwayEnv", "class"),
    ],
)
def test_a_teachers_mistake_is_told_when_read(folder: Path, old: str, new: str, message: str) -> None:
    (folder / "assignment.yaml").write_text(ASSIGNMENT_TEXT.replace(old, new))
    with pytest.raises(WorldError, match=message):
        read_assignment(folder)


def test_the_sectors_are_those_that_agents_of_the_kit_see() -> None:
    ranges = [1.0 + 0.001 * ray for ray in range(91)]
    wanted = [min(ranges[ray] for ray in range(91) if NINE_NUMBERS.sectors[ray] == k) for k in range(9)]
    assert sector_minima(ranges, 9, 2.0) == wanted
    assert sector_minima([math.nan] * 91, 9, 2.0) == [2.0] * 9


def test_each_episode_is_named_while_it_runs(folder: Path) -> None:
    said: list[str] = []
    graded(folder, ("self.steps += 1", "1 / 0"), options=replace(DESK, show_progress=said.append))
    assert said == ["starting the program", "episode “turning on the spot”"]
