"""From a program to a verdict: shares, dependencies, secrets, the grader's own faults, the command line, the plugin."""

from __future__ import annotations

import dataclasses
import json
import random
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
from click.testing import CliRunner

import grader.check as contract
from grader.__main__ import VERBS, main
from grader.assignment import Assignment
from grader.budgets import BUDGET_KEYS
from grader.driving import check_table
from grader.grading import GradingOptions, grade, open_grading
from grader.grading_level import LevelTooLow
from grader.kinds.contract import find_kind, kind_names
from grader.kinds.controller import kind as controller
from grader.reading import read_assignment
from grader.self_test import try_works, unfair_fail_odds
from grader.submission import Submission
from kit.host.program_start import child_seed
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import CriterionStatus, GradingResult, GradingVerdict
from kit.run.recording import load_recording
from tests.cases import every_case
from tests.grader.conftest import FORWARD, QUICK, TEMPLATES, write_assignment

DESK = GradingOptions(Level.LIMITED)


def handed_in(source: str) -> Submission:
    return Submission("ada", "controller.py", {"controller.py": source.encode()})


def statuses(result: GradingResult) -> dict[str, str]:
    return {test.id: test.status.value for test in result.tests}


def test_an_honest_program(quick: Assignment) -> None:
    result = grade(quick, handed_in(FORWARD), DESK)
    assert statuses(result) == {"runs": "pass", "moves": "pass", "reached": "fail"}
    assert (result.points, result.max_points, result.verdict) == (3.0, 6.0, GradingVerdict.FAIL)
    failed = result.tests[2]
    assert failed.hints == ("one", "two", "three")
    assert (failed.expected, failed.actual) == ("reached", "not reached")
    assert "#" in failed.replay
    assert failed.episodes[0].name == "turn, seed 1"
    assert result.steps == 400


def test_partial_credit(quick: Assignment) -> None:
    result = grade(quick, handed_in(FORWARD.replace("SPEED = 0.3", "SPEED = 0.06")), DESK)
    assert statuses(result)["moves"] == "partial"
    assert 0.5 < result.tests[1].points < 1.5


def test_what_depends_on_a_failure_is_not_judged(quick: Assignment) -> None:
    result = grade(quick, handed_in("import rclpy\nx = 1 / 0\n"), DESK)
    assert statuses(result) == {"runs": "student_error", "moves": "skipped", "reached": "skipped"}
    assert result.points == 0.0
    assert "controller.py:2" in result.tests[0].rationale
    assert result.tests[1].depends_on == "runs"
    assert result.verdict is GradingVerdict.FAIL


def test_the_same_program_gets_the_same_result(quick: Assignment) -> None:
    one, two = (grade(quick, handed_in(FORWARD), DESK) for _ in range(2))
    assert dataclasses.replace(one, timing=two.timing) == two


@pytest.mark.long
def test_a_share_of_episodes_may_be_enough(tmp_path: Path) -> None:
    """The program drives with even seeds only."""
    source = FORWARD.replace(
        "SPEED = 0.3", "import random\nSPEED = 0.3 if random.Random().random() < 2 else 0.0"
    )
    source = source.replace("random.Random().random() < 2", "MODEL_OK").replace(
        "class Forward", "import os, random\nMODEL_OK = random.random() < 0.5\n\nclass Forward"
    )
    text = QUICK.replace("seeds: [1]", "seeds: [1, 2, 3, 4]").replace("time: 4", "time: 2")
    shares = {}
    for need in ("0.25", "1.0", None):
        extra = "" if need is None else f", need: {need}"
        folder = write_assignment(
            tmp_path / f"n{need}", text.replace("{none: 0, full: 0.5}", "{none: 0, full: 0.4}" + extra)
        )
        result = grade(read_assignment(folder), handed_in(source), DESK)
        shares[need] = result.tests[1].metrics["share"]
    driven = shares["1.0"]
    assert 0.0 < driven < 1.0, "some seeds drive, some do not"
    assert shares["0.25"] == 1.0
    assert shares[None] == pytest.approx(driven, abs=0.01)


SECRET = QUICK.replace("level: 0", "level: 1")


@pytest.mark.long
def test_secret_seeds_are_used_for_the_grade_alone(tmp_path: Path) -> None:
    text = SECRET.replace("check: reached, points: 3", "check: reached, seeds: secret, points: 3")
    assignment = read_assignment(write_assignment(tmp_path / "s", text, secret="seeds: {turn: [123456789]}"))
    practice = grade(assignment, handed_in(FORWARD), GradingOptions(Level.LIMITED))
    assert statuses(practice)["reached"] == "skipped"
    assert any("1 more tests" in notice for notice in practice.notices)
    with pytest.raises(LevelTooLow, match="level 1"):
        grade(assignment, handed_in(FORWARD), GradingOptions(Level.LIMITED, secret=True))
    trusting = dataclasses.replace(assignment, level=Level.LIMITED)
    final = grade(trusting, handed_in(FORWARD), GradingOptions(Level.LIMITED, secret=True, examples=True))
    assert statuses(final)["reached"] == "fail"
    assert final.seeds == "public+secret"
    assert "123456789" not in json.dumps(final.as_dict())
    assert final.tests[2].episodes[0].name == "turn, secret seed 1"
    assert "secret" not in final.tests[2].rationale, "a public seed fails too, and is shown instead"
    assert final.tests[2].replay
    assert json.dumps(final.for_student().as_dict()).count("secret seed") == 0


@pytest.mark.long
def test_an_error_with_a_secret_seed_carries_nothing_out(tmp_path: Path) -> None:
    text = SECRET.replace("level: 1", "level: 0").replace("check: runs,", "check: runs, seeds: secret,")
    assignment = read_assignment(write_assignment(tmp_path / "s", text, secret="seeds: {turn: [5]}"))
    source = FORWARD.replace(
        "        self.drive.publish",
        "        import random; raise ValueError(f'I saw {random.random()}')\n        self.drive.publish",
    )
    result = grade(assignment, handed_in(source), GradingOptions(Level.LIMITED, secret=True, examples=True))
    assert result.tests[0].status is CriterionStatus.STUDENT_ERROR
    saw = f"I saw {random.Random(child_seed(5)).random()}"
    assert saw not in json.dumps(result.as_dict()), "not even the teacher's copy holds it"
    assert "I saw 0." in result.tests[0].rationale, "a public seed that fails as well is shown"


def test_a_check_that_breaks_costs_nobody_anything(
    quick: Assignment, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(drive: object, params: object) -> float:
        raise KeyError("ours")

    table = dict(check_table.CHECKS)
    table["moves"] = dataclasses.replace(table["moves"], measure=broken)
    monkeypatch.setattr(controller, "KIND", dataclasses.replace(controller.KIND, checks=table))
    result = grade(quick, handed_in(FORWARD), DESK)
    assert statuses(result)["moves"] == "grader_error"
    assert (result.verdict, result.points) == (GradingVerdict.BROKEN, None)
    assert "KeyError" in result.tests[1].log


def test_a_docstring_is_the_feedback() -> None:
    @contract.check(none=0, full=10, unit="m")
    def far(drive: object, params: object) -> float:
        """Only {actual}
        of {full}."""
        return 3.0

    assert far.feedback == "Only {actual} of {full}."
    assert (far.format(2.5), far.format(3.0)) == ("2.5 m", "3 m")


@pytest.mark.long_cases("controller", "reward", "world")
@pytest.mark.parametrize("kind", sorted(each.name for each in TEMPLATES.iterdir() if each.is_dir()))
def test_the_templates_prove_themselves(kind: str) -> None:
    assignment = dataclasses.replace(read_assignment(TEMPLATES / kind), level=Level.LIMITED)
    reports = list(try_works(assignment, DESK))
    assert {report.name: report.problems for report in reports if report.problems} == {}
    assert len(reports) >= 4


@pytest.mark.long
def test_an_assignment_that_does_not_do_what_it_should_is_found_out(tmp_path: Path) -> None:
    folder = write_assignment(tmp_path / "q")
    (folder / "starter.py").write_text("1/0\n")
    (folder / "solution.py").write_text(FORWARD)
    wrong = folder / "wrong"
    wrong.mkdir()
    (wrong / "moves.py").write_text(FORWARD)
    (wrong / "nothing.py").write_text(FORWARD)
    (wrong / "reached__ok.py").write_text(FORWARD)
    problems = {
        report.name: "\n".join(report.problems) for report in try_works(read_assignment(folder), DESK)
    }
    assert "student_error" in problems["starter.py"]
    assert "reached: fail" in problems["solution.py"]
    assert "should lose moves, and does not" in problems["wrong/moves.py"]
    assert "loses reached, which it should not" in problems["wrong/moves.py"]
    assert "must start with criteria" in problems["wrong/nothing.py"]
    assert problems["wrong/reached__ok.py"] == ""


@pytest.mark.long
def test_chance_is_found_out(tmp_path: Path) -> None:
    folder = write_assignment(tmp_path / "q")
    for name in ("starter.py", "solution.py"):
        (folder / name).write_text(
            FORWARD.replace(
                "SPEED = 0.3", "import os\nSPEED = 0.1 + int.from_bytes(os.urandom(2), 'big') / 2**18"
            )
        )
    problems = {
        report.name: "\n".join(report.problems) for report in try_works(read_assignment(folder), DESK)
    }
    assert "two runs give different results" in problems["solution.py"]


def test_the_odds_are_told(tmp_path: Path) -> None:
    text = QUICK.replace("seeds: [1]", f"seeds: {list(range(10))}").replace(
        "check: reached,", "check: reached, need: 0.9,"
    )
    told = {
        each.criterion: each
        for each in unfair_fail_odds(read_assignment(write_assignment(tmp_path / "q", text)), secret=False)
    }
    assert (told["reached"].required_passes, told["reached"].episodes) == (9, 10)
    assert told["reached"].probabilities[1] == pytest.approx(0.086, abs=1e-3)


def test_evidence_for_a_teachers_own_tests(quick: Assignment) -> None:
    with open_grading(quick, handed_in(FORWARD), DESK) as grading:
        (drive,) = grading.evidence("moves")
        assert drive.steps == 400
        assert grading.result().verdict is GradingVerdict.FAIL
        assert grading.scores.worst() is drive


@pytest.mark.long
def test_a_shutdown_that_ends_the_program_first_leaves_no_result(tmp_path: Path) -> None:
    """The program gets the signal before the grader does: nobody is told that it crashed."""
    folder = write_assignment(tmp_path / "q")
    file, out = tmp_path / "ada.py", tmp_path / "result.json"
    file.write_text("import os, signal\nos.kill(os.getpid(), signal.SIGTERM)\n")
    grader = [sys.executable, "-P", "-m", "grader", "check", str(file), "--assignment", str(folder), "--json"]
    running = subprocess.Popen([*grader, "--output", str(out)], stderr=subprocess.PIPE)
    assert running.wait(60) == 1, "left alone, it says so"
    assert out.exists()
    out.unlink()
    source = (
        "import sys; from pathlib import Path; from grader import grading; import grader.__main__ as command\n"
        "grading.time.sleep = lambda seconds: sys.exit(143)  # here the signal comes\n"
        "command.main()"
    )
    cut = subprocess.run([sys.executable, "-P", "-c", source, *grader[4:], "--output", str(out)], check=False)
    assert cut.returncode == 143
    assert not out.exists()
    assert running.stderr is not None
    running.stderr.close()


# The command line


def invoke(*arguments: str) -> tuple[int, str]:
    done = CliRunner().invoke(main, list(arguments))
    assert not done.exception or isinstance(done.exception, SystemExit), done.exc_info
    return done.exit_code, done.output


@pytest.mark.long
def test_check_in_every_way(tmp_path: Path) -> None:
    folder = write_assignment(tmp_path / "q")
    file = tmp_path / "ada.py"
    file.write_text(FORWARD)
    replay = tmp_path / "worst.npz"
    code, text = invoke(
        "check", str(file), "--assignment", str(folder), "--hints", "2", "--replay", str(replay)
    )
    assert code == 1
    assert "3 of 6 points. Not passed yet." in text
    assert "Hint 2 of 3: two" in text
    assert "--hints 3" in text
    assert "kit replay" in text
    assert load_recording(replay).ticks == 400
    out = tmp_path / "result.json"
    assert invoke("check", str(file), "--assignment", str(folder), "--json", "--output", str(out)) == (1, "")
    assert GradingResult.from_dict(json.loads(out.read_text())).points == 3.0
    code, junit = invoke("report", str(out), "--format", "junit")
    assert code == 0
    assert ElementTree.fromstring(junit).attrib["failures"] == "1"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--assignment", "Q", "--format", "pdf"), "There is no format pdf"),
        (("--assignment", "Q", "--secret", "--level", "0"), "level 1"),
        (("--assignment", "BAD"), "assignment.yaml:2:1"),
    ],
)
def test_a_users_mistake_is_one_clear_message(tmp_path: Path, arguments: tuple[str, ...], said: str) -> None:
    folders = {
        "Q": str(write_assignment(tmp_path / "q", SECRET)),
        "BAD": str(write_assignment(tmp_path / "bad", "title: x\nfoo: 1\n")),
    }
    file = tmp_path / "ada.py"
    file.write_text(FORWARD)
    code, text = invoke("check", str(file), *(folders.get(each, each) for each in arguments))
    assert code == 2
    assert said in text


def test_a_submission_that_cannot_be_taken(tmp_path: Path) -> None:
    folder = write_assignment(tmp_path / "q")
    (tmp_path / "ada.zip").write_bytes(b"no")
    code, text = invoke("check", str(tmp_path / "ada.zip"), "--assignment", str(folder))
    assert code == 2
    assert "damaged" in text


def test_every_verb_explains_itself() -> None:
    code, text = invoke("--help")
    assert code == 0
    for verb, (_, about) in VERBS.items():
        assert (verb in text) is bool(about) or verb == "work"
        assert invoke(verb, "--help")[0] == 0
    code, text = invoke("chek")
    assert code == 2
    assert "Did you mean `grader check`?" in text


@every_case("kind", kind_names())
def test_what_can_be_checked_is_listed(kind: str) -> None:
    code, text = invoke("checks", kind)
    assert all(f"\n  {key.name} " in text for key in BUDGET_KEYS)
    assert code == 0
    assert all(f"\n{name}" in f"\n{text}" for name in find_kind(kind).checks)
    assert max(map(len, text.splitlines())) <= 80
    assert invoke("checks", f"{kind}x")[0] == 2


def test_a_new_assignment_is_a_working_one(tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    assert invoke("new", str(folder), "--kind", "reward")[0] == 0
    assert read_assignment(folder).id == "mine"
    assert not list(folder.rglob("__pycache__"))
    code, text = invoke("new", str(folder))
    assert code == 2
    assert "not empty" in text


# The plugin


def run_pytest(folder: Path, submission: Path, *more: str) -> tuple[int, str, ElementTree.Element]:
    report = folder.parent / "junit.xml"
    done = subprocess.run(
        [
            *(sys.executable, "-P", "-m", "pytest", "-p", "grader.plugin", "-p", "no:cacheprovider", "-q"),
            *("--rootdir", str(folder), "-c", "/dev/null", "--submission", str(submission)),
            *("--grading-level", "0", "--junitxml", str(report), *more, str(folder)),
        ],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    return done.returncode, done.stdout + done.stderr, ElementTree.parse(report).getroot()


OWN = """
def test_of_the_teachers_own(grading):
    (drive,) = grading.evidence("moves")
    assert drive.score.distance_m > 0.5
"""


@pytest.mark.long
def test_the_plugin_judges_and_collects_nothing_of_the_students(tmp_path: Path) -> None:
    folder = write_assignment(tmp_path / "q")
    (folder / "test_own.py").write_text(OWN)
    handed = tmp_path / "handed"
    handed.mkdir()
    (handed / "controller.py").write_text(FORWARD)
    (handed / "conftest.py").write_text("raise SystemExit(0)")
    (handed / "test_mine.py").write_text("def test_free_points(): pass")
    code, text, report = run_pytest(folder, handed)
    assert code == 1
    assert "3 passed" in text, text
    assert "1 failed" in text
    assert "expected reached, got not reached" in text
    cases = {case.attrib["name"]: case for case in report.iter("testcase")}
    assert set(cases) == {"runs", "moves", "reached", "test_of_the_teachers_own"}
    points = {each.attrib["name"]: each.attrib["value"] for each in cases["moves"].iter("property")}
    assert points == {"points": "2", "max_points": "2", "status": "pass"}


@pytest.mark.long
def test_the_plugin_tells_failed_from_skipped(tmp_path: Path) -> None:
    folder = write_assignment(tmp_path / "q")
    file = tmp_path / "ada.py"
    file.write_text("1/0\n")
    code, text, _ = run_pytest(folder, file)
    assert code == 1
    assert "1 failed, 2 skipped" in text
    assert "ZeroDivisionError" in text


@pytest.mark.long
def test_the_plugin_calls_a_broken_grader_an_error(tmp_path: Path) -> None:
    folder = write_assignment(tmp_path / "q")
    (folder / "conftest.py").write_text(
        "import dataclasses\nfrom grader.driving import check_table\n"
        "def broken(drive, params): raise KeyError('ours')\n"
        "check_table.CHECKS = {k: dataclasses.replace(v, measure=broken) for k, v in check_table.CHECKS.items()}\n"
    )
    file = tmp_path / "ada.py"
    file.write_text(FORWARD)
    _, text, report = run_pytest(folder, file)
    assert "3 errors" in text, text
    assert report.find("testsuite").attrib["failures"] == "0"  # type: ignore[union-attr]  # pytest writes one


def test_a_mistake_that_costs_every_criterion_is_described_once(tmp_path: Path) -> None:
    (tmp_path / "assignment.yaml").write_text(
        "title: Two\nkind: answers\nsubmit: answers.yaml\nlevel: 0\n"
        "questions: {one: {ask: 1 + 0}, two: {ask: 1 + 1}}\n"
        "answers: {one: {right: ['1']}, two: {right: ['2']}}\n"
        "checks:\n"
        "  - {check: answers, id: first, title: The first, points: 1, with: {keys: [one]}}\n"
        "  - {check: answers, id: second, title: The second, points: 1, with: {keys: [two]}}\n"
    )
    submission = Submission("ada", "answers.yaml", {"answers.yaml": b"one: [1"})
    result = grade(read_assignment(tmp_path), submission, GradingOptions(Level.LIMITED))
    first, second = result.tests
    assert "answers.yaml:" in first.rationale
    assert second.rationale == "The same mistake as in “The first”."
    assert result.points == 0


def test_a_starter_that_earns_too_much_is_told(tmp_path: Path) -> None:
    folder = write_assignment(tmp_path / "task", QUICK)
    (folder / "starter.py").write_text(FORWARD)
    starter = next(iter(try_works(read_assignment(folder), DESK)))
    assert "it earns 3 of 6 points" in starter.problems[0]


def test_what_comes_after_what_had_not_its_turn_has_not_its_turn_either(tmp_path: Path) -> None:
    """Also where the criteria between are measured elsewhere, and would be met by doing nothing."""
    sheet = """
title: Three words
kind: function
submit: words.py
level: 0
functions: [{name: one}, {name: two}, {name: three}]
checks:
  - {check: agrees, id: one, points: 1, with: {function: one}}
  - {check: agrees, id: two, points: 1, after: one, with: {function: two}}
  - {check: agrees, id: three, points: 1, after: two, with: {function: three}}
"""
    names = ("one", "two", "three")
    task = write_assignment(tmp_path / "task", sheet)
    cases = "".join(
        f"def {name}(x): return x\ndef {name}_cases(random): yield {{'x': 1.0}}\n" for name in names
    )
    (task / "reference.py").write_text(cases)
    assignment = read_assignment(task)
    for returned, earned in (("x", [1, 1, 1]), ("x + 1", [0, 0, 0])):
        text = f"def one(x): return {returned}\ndef two(x): return x\ndef three(x): return x\n"
        work = Submission("words", assignment.submit, {assignment.submit: text.encode()})
        result = grade(assignment, work, GradingOptions(Level.LIMITED))
        assert [each.points for each in result.tests] == earned
