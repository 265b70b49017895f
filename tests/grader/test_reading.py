"""An assignment's folder: what is read, and how mistakes are told."""

from __future__ import annotations

from pathlib import Path

import pytest

from grader.evidence_digest import folder_digest
from grader.reading import read_assignment
from grader.scoring import Anchors
from kit.world.problems import WorldError
from tests.cases import every_case
from tests.grader.conftest import QUICK, TEMPLATES, write_assignment


@pytest.mark.parametrize("kind", sorted(each.name for each in TEMPLATES.iterdir() if each.is_dir()))
def test_the_templates_can_be_read(kind: str) -> None:
    made = read_assignment(TEMPLATES / kind)
    assert made.max_points > 0
    assert made.kind == kind


def test_what_is_read(tmp_path: Path) -> None:
    made = read_assignment(write_assignment(tmp_path / "q", secret="seeds: {turn: [11, 12]}"))
    (trial,) = made.trials
    assert (trial.seeds, trial.secret_seeds, trial.time_s) == ((1,), (11, 12), 4.0)
    assert made.criteria[1].anchors == Anchors(0.0, 0.5)
    assert made.criteria[2].hints == ("one", "two", "three")
    assert made.id == "q"
    assert made.has_secrets


MISTAKES = {
    "kind: controler": ("kind", "did you mean"),
    "titel: x": ("titel", "unknown key"),
    "submit: ../x.py": ("submit", "plain name"),
    "submit: x.sh": ("submit", ".py"),
    "level: 9": ("level", "at most 3"),
    "budget: {reply: -1}": ("reply", "greater than 0"),
    "checks: [{check: reachd, points: 1}]": ("reachd", "did you mean"),
    "checks: [{check: reached}]": ("points", "missing"),
    "checks: [{check: reached, points: 1, after: later}]": ("later", "none so far"),
    "checks: [{check: reached, points: 1, on: [tirn]}]": ("tirn", "did you mean"),
    "checks: [{check: reached, points: 1}, {check: reached, points: 1}]": ("reached", "already exists"),
    "checks: [{check: rate, points: 1, with: {topc: x}}]": ("topc", "did you mean"),
    "checks: [{check: reached, points: 1, hints: [a, b, c, d]}]": ("hints", "at most 3"),
    "trials: [{name: a, place: trun}]": ("trun", "did you mean"),
    "trials: [{name: a, place: turn, case: x}]": ("turn", "no case x"),
    "trials: [{name: a, place: turn, seeds: [1, 1]}]": ("seeds", "twice"),
    "trials: [{name: a, place: turn, seeds: [1.5]}]": ("seeds", "whole number"),
    "trials: [{name: a, place: turn, services: [move_modle]}]": ("move_modle", "did you mean"),
    "trials: [{name: a, place: turn}, {name: a, place: turn}]": ("a", "already exists"),
}


@pytest.mark.parametrize("line", MISTAKES)
def test_a_mistake_names_its_place_and_the_way_out(tmp_path: Path, line: str) -> None:
    key = line.partition(":")[0]
    kept = [each for each in QUICK.splitlines() if not each.startswith(key + ":")]
    if key in ("checks", "trials"):
        kept = [each for each in kept if not each.startswith("  - ") or key != "checks"]
    folder = write_assignment(tmp_path / "q", "\n".join([*kept, line]) + "\n")
    with pytest.raises(WorldError) as caught:
        read_assignment(folder)
    told = str(caught.value)
    for word in MISTAKES[line]:
        assert word in told
    number = len([*kept, line])
    assert any(problem.startswith(f"{folder}/assignment.yaml:{number}:") for problem in told.splitlines()), (
        told
    )


@pytest.mark.parametrize(
    ("topics", "said"),
    [
        ("odometry/ground_truth", ""),
        ("/odometry/ground_truth", ""),
        ("odometry/groundtruth", "did you mean"),
        ("scan", "no ground-truth topic"),
    ],
)
def test_the_truths_that_a_trial_offers_are_truths_of_its_world(
    tmp_path: Path, topics: str, said: str
) -> None:
    """A misspelt one would be offered to nobody, without a word."""
    text = QUICK.replace("time: 4,", f"time: 4, topics: [{topics}],")
    folder = write_assignment(tmp_path / "q", text)
    if not said:
        assert read_assignment(folder).trials[0].topics == {topics}
        return
    with pytest.raises(WorldError, match=said):
        read_assignment(folder)


def test_all_mistakes_are_told_at_once(tmp_path: Path) -> None:
    folder = write_assignment(
        tmp_path / "q", QUICK.replace("level: 0", "level: 7\nfoo: 1").replace("place: turn", "place: tarn")
    )
    with pytest.raises(WorldError) as caught:
        read_assignment(folder)
    assert len(caught.value.problems) >= 3


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ("###\n#G#", "walls all around"),
        ("####\n#.#\n####", "equal length"),
        ("####\n#..#\n####", "exactly one G"),
        ("####\n#GX#\n####", "drawn with"),
    ],
)
def test_a_grid_that_is_no_map(tmp_path: Path, rows: str, said: str) -> None:
    drawn = "\n".join(f"    {row}" for row in rows.splitlines())
    text = f"title: R\nkind: reward\nsubmit: r.py\ngrid:\n  map: |\n{drawn}\nchecks: [{{check: contract, points: 1}}]\n"
    with pytest.raises(WorldError, match=said):
        read_assignment(write_assignment(tmp_path / "r", text))


def test_the_version_changes_with_what_is_graded_and_with_nothing_else(tmp_path: Path) -> None:
    folder = write_assignment(tmp_path / "q")
    before = folder_digest(folder)
    (folder / "README.md").write_text("new words")
    (folder / "starter.py").write_text("pass")
    assert folder_digest(folder) == before
    (folder / "secret.yaml").write_text("seeds: {turn: [5]}")
    assert folder_digest(folder) != before


def test_a_world_of_the_teachers_own(tmp_path: Path) -> None:
    from kit.world.catalogue import find_map

    folder = tmp_path / "q"
    card = find_map("turn")
    folder.mkdir()
    for file in (*card.folder.iterdir(), *(card.folder.parent / "robots").iterdir()):
        (folder / file.name).write_bytes(file.read_bytes())
    world = folder / "world.yaml"
    world.write_text(world.read_text().replace("../robots/", ""))
    own = QUICK.replace("place: turn", "place: world.yaml, target: [1.6, 1.6], target_radius: 0.3")
    (trial,) = read_assignment(write_assignment(folder, own)).trials
    assert trial.scenario.case is not None
    assert trial.scenario.case.target == (1.6, 1.6)


TOO_MUCH = {
    "controller trials: [{name: a, place: turn, time: 3601}]": 3600,
    "controller budget: {submission: 14401}": 14400,
    "controller checks: [{check: reached, points: 1, share: {none: 0, full: 1, steps: 21}}]": 20,
    "drive drive: {place: simple, time: 601}": 600,
    "environment environment: {class: Env, place: turn, case: turn_a_to_b, moves: [[0.5, 0]], max_steps: 401}": 400,
    "launch launch: {package: ., runs: [{name: a, time: 61}]}": 60,
    "policy policy: {task: turn, episodes: 1001}": 1000,
    "task task: {algorithm: sarsa, trainings: 6}": 5,
    "task task: {algorithm: sarsa, episodes: 501}": 500,
    "task task: {algorithm: sarsa, steps: 500001}": 500_000,
    "training training: {task: turn, algorithms: [sarsa], steps: 5000001, seeds: [1]}": 5_000_000,
    "training training: {task: turn, algorithms: [sarsa], steps: 1000, seeds: [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, "
    "13, 14, 15, 16, 17, 18, 19, 20]}": 20,
    "world trials: [{name: a, time: 121}]": 120,
    f"reward grid: {{map: '{'#' * 41}'}}": 40,
}


@every_case("line, most", TOO_MUCH.items())
def test_an_assignment_that_asks_for_more_than_is_run_is_told_the_most(
    line: str, most: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    kind, _, setting = line.partition(" ")
    folder = tmp_path_factory.mktemp("q")
    (folder / "assignment.yaml").write_text(f"title: Much\nkind: {kind}\nsubmit: x\n{setting}\n")
    with pytest.raises(WorldError) as caught:
        read_assignment(folder)
    assert f"at most {most}" in str(caught.value), str(caught.value)
