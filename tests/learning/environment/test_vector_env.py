"""The contract of Gymnasium's vector environments: single environments in one process, in several, and the batch of worlds
return the same."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.wrappers import vector as wrappers

import kit  # noqa: F401 - registers the environments
from kit.learning.environment.env import TaskEnv
from kit.learning.environment.vector_env import BatchVectorEnv
from kit.learning.tasks.catalogue import TURN, WHEELCHAIRS
from kit.learning.tasks.learning_task import UnknownTask

N = 3
STEPS = 40
QUICK = replace(TURN, max_steps=12)
ONE_CASE = "turn_a_to_b"
TASKS = {"Turn": QUICK.on(ONE_CASE), "Wheelchairs": replace(WHEELCHAIRS, max_steps=9).on("pair_straight")}
FORMS = ("sync", "vector_entry_point", "async")


def make(form: str, mode: AutoresetMode, name: str = "Turn", **more: Any) -> VectorEnv[Any, Any, Any]:
    """Some worlds in one of the forms that Gymnasium has."""
    if form == "vector_entry_point":
        more["autoreset_mode"] = mode
    else:
        more["vector_kwargs"] = {"autoreset_mode": mode}
    return gymnasium.make_vec(
        f"RobotKit/{name}-v0", num_envs=N, vectorization_mode=form, task=TASKS[name], **more
    )


def tape(env: VectorEnv[Any, Any, Any], **options: Any) -> Iterator[Any]:
    """What comes of a reset and some steps; in the mode DISABLED the worlds that have ended are reset by a mask."""
    chance = np.random.default_rng(3)
    env.action_space.seed(7)
    yield env.reset(**options)
    for _ in range(STEPS):
        actions = env.action_space.sample()
        found = env.step(actions)
        yield found
        over = found[2] | found[3]
        if env.metadata["autoreset_mode"] is AutoresetMode.DISABLED and over.any():
            yield env.reset(options={"reset_mask": over}, seed=[int(chance.integers(99)) for _ in range(N)])


def assert_same(one: Any, other: Any, place: str) -> None:
    if isinstance(one, dict):
        assert sorted(one) == sorted(other), place
        for key in one:
            assert_same(one[key], other[key], f"{place}.{key}")
    elif isinstance(one, tuple):
        assert len(one) == len(other), place
        for number, (each, beside) in enumerate(zip(one, other, strict=True)):
            assert_same(each, beside, f"{place}[{number}]")
    elif isinstance(one, np.ndarray) and one.dtype.hasobject:
        assert one.shape == other.shape, place
        for each, beside in zip(one.tolist(), other.tolist(), strict=True):
            assert np.array_equal(each, beside), place
    else:
        assert np.array_equal(one, other), f"{place}: {one} and {other}"
        assert np.asarray(one).dtype == np.asarray(other).dtype, place


@pytest.mark.parametrize("mode", AutoresetMode, ids=lambda mode: mode.value)
@pytest.mark.parametrize("name", TASKS)
@pytest.mark.parametrize("form", [FORMS[1], pytest.param(FORMS[2], marks=pytest.mark.long)])
def test_all_forms_return_the_same(form: str, name: str, mode: AutoresetMode) -> None:
    with closing(make("sync", mode, name)) as one, closing(make(form, mode, name)) as other:
        for options in ({"seed": 5}, {"seed": [8, None, 2]}, {}):
            for step, (expected, found) in enumerate(
                zip(tape(one, **options), tape(other, **options), strict=True)
            ):
                assert_same(expected, found, f"{options}, step {step}")


@pytest.mark.parametrize("form", FORMS[:2])
def test_episodes_are_cut_off_where_asked(form: str) -> None:
    env = make(form, AutoresetMode.NEXT_STEP, max_episode_steps=4)
    env.reset(seed=1)
    stops = np.full(N, 1)  # turns on the spot
    cut = [env.step(stops)[3].tolist() for _ in range(10)]
    assert [all(each) for each in cut] == [False] * 3 + [True] + [False] * 4 + [True, False]


@pytest.mark.parametrize(
    ("wrap", "mode"),
    [
        (wrappers.NormalizeObservation, AutoresetMode.NEXT_STEP),
        (wrappers.NormalizeReward, AutoresetMode.NEXT_STEP),
        (wrappers.RecordEpisodeStatistics, AutoresetMode.NEXT_STEP),
        (wrappers.RecordEpisodeStatistics, AutoresetMode.SAME_STEP),
        (wrappers.DictInfoToList, AutoresetMode.NEXT_STEP),
        (lambda env: wrappers.ClipReward(env, -1, 1), AutoresetMode.SAME_STEP),
        (
            lambda env: wrappers.RescaleObservation(env, np.float32(-1), np.float32(1)),
            AutoresetMode.NEXT_STEP,
        ),
        (lambda env: wrappers.FlattenObservation(env), AutoresetMode.NEXT_STEP),
        (lambda env: wrappers.TransformReward(env, lambda reward: 2 * reward), AutoresetMode.SAME_STEP),
    ],
    ids=lambda each: getattr(each, "__name__", str(each)),
)
def test_gymnasiums_wrappers_take_it(wrap: Any, mode: AutoresetMode) -> None:
    env = wrap(make("vector_entry_point", mode))
    assert len(list(tape(env, seed=1))) == STEPS + 1


def test_gymnasiums_own_default_is_the_kits() -> None:
    env = gymnasium.make_vec("RobotKit/Turn-v0", num_envs=2)
    assert isinstance(env, BatchVectorEnv)
    assert env.metadata["autoreset_mode"] is gymnasium.vector.SyncVectorEnv([TaskEnv]).autoreset_mode
    assert env.unwrapped.spec is not None


@pytest.mark.parametrize(
    "name", ["task", "render_mode", "observation_space", "action_space", "metadata", "render"]
)
def test_worlds_are_asked_alike_in_every_form(name: str) -> None:
    one, other = (make(form, AutoresetMode.NEXT_STEP, render_mode="ansi") for form in FORMS[:2])
    for env in (one, other):
        env.reset(seed=4)
    expected, found = one.call(name), other.call(name)
    assert len(expected) == len(found) == N
    if name == "metadata":
        assert [expected[0][key] == found[0][key] for key in expected[0]] == [True] * len(expected[0])
    elif name != "render":
        assert expected == found == other.get_attr(name)
    else:
        assert [each.splitlines()[-1] for each in found] == [each.splitlines()[-1] for each in expected]


def test_what_worlds_of_a_batch_cannot_do_alone_is_said() -> None:
    env = BatchVectorEnv(2, QUICK)
    assert env.call("render") == (None, None)
    for refused in (
        lambda: env.set_attr("difficulty", [1, 2]),
        lambda: env.get_attr("difficulty"),
        lambda: env.call("reset"),
    ):
        with pytest.raises(AttributeError, match="sync"):
            refused()


@pytest.mark.parametrize("mode", ["rgb_array", "ansi"])
def test_every_world_has_a_picture(mode: str) -> None:
    one, other = (make(form, AutoresetMode.NEXT_STEP, render_mode=mode) for form in FORMS[:2])
    for env in (one, other):
        env.reset(seed=4)
    pictures, beside = one.render(), other.render()
    assert pictures is not None
    assert beside is not None
    for each, same in zip(pictures, beside, strict=True):
        assert type(each) is type(same)
        assert np.shape(each) == np.shape(same)
    assert len({np.asarray(each).tobytes() for each in beside}) == N


def test_a_case_can_be_asked_for() -> None:
    env = BatchVectorEnv(4, QUICK)
    assert env.reset(seed=1)[1]["case"].tolist() == ["turn_a_to_b", "turn_b_to_a"] * 2
    assert env.reset(options={"case": "turn_b_to_a"})[1]["case"].tolist() == ["turn_b_to_a"] * 4
    mask = np.array([True, False, False, True])
    _, info = env.reset(options={"case": ONE_CASE, "reset_mask": mask})
    assert info["case"][mask].tolist() == [ONE_CASE] * 2
    assert info["_case"].tolist() == mask.tolist()


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda: BatchVectorEnv(0, QUICK), ValueError, "at least one"),
        (lambda: BatchVectorEnv(2, QUICK, render_mode="film"), ValueError, "film"),
        (lambda: BatchVectorEnv(2, QUICK, max_episode_steps=0), ValueError, "at least one step"),
        (lambda: BatchVectorEnv(2, QUICK, autoreset_mode="never"), ValueError, "never"),
        (lambda: BatchVectorEnv(2, QUICK).reset(seed=[1]), ValueError, "2 environments"),
        (lambda: BatchVectorEnv(2, QUICK).reset(options={"cse": ONE_CASE}), ValueError, "case"),
        (lambda: BatchVectorEnv(2, QUICK).reset(options={"case": "turn_c"}), UnknownTask, "turn_a_to_b"),
        (lambda: BatchVectorEnv(2, QUICK).reset(options={"reset_mask": [True, True]}), TypeError, "bool"),
        (
            lambda: BatchVectorEnv(2, QUICK).reset(options={"reset_mask": np.zeros(2, bool)}),
            ValueError,
            "at least one",
        ),
        (
            lambda: BatchVectorEnv(2, QUICK).reset(options={"reset_mask": np.array([True, False])}),
            gymnasium.error.ResetNeeded,
            "all",
        ),
        (lambda: BatchVectorEnv(2, QUICK).step(np.zeros(2)), gymnasium.error.ResetNeeded, "reset"),
        (lambda: TaskEnv(QUICK).reset(options={"cse": ONE_CASE}), ValueError, "case"),
    ],
)
def test_what_is_no_option_is_refused(call: Any, error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=words):
        call()


def test_a_world_that_nobody_resets_is_said() -> None:
    env = BatchVectorEnv(2, QUICK, autoreset_mode=AutoresetMode.DISABLED)
    env.reset(seed=1)
    for _ in range(QUICK.max_steps):
        env.step(np.ones(2))
    with pytest.raises(gymnasium.error.ResetNeeded, match="environment 0 is over"):
        env.step(np.ones(2))


def test_the_spec_says_how_long_an_episode_is() -> None:
    for name, steps in (("Turn", 200), ("Wheelchairs", 300)):
        env = gymnasium.make(f"RobotKit/{name}-v0")
        assert env.spec is not None
        assert env.spec.max_episode_steps == steps
        again = gymnasium.make(env.spec)
        assert again.spec is not None
        assert again.spec.max_episode_steps == steps
        worlds = gymnasium.make_vec(f"RobotKit/{name}-v0", num_envs=2)
        assert worlds.spec is not None
        assert worlds.spec.max_episode_steps == steps
    for env in (
        gymnasium.make("RobotKit/Turn-v0", task="smooth-turn", max_episode_steps=7),
        gymnasium.make_vec("RobotKit/Turn-v0", num_envs=2, task="smooth-turn", max_episode_steps=7),
    ):
        assert env.spec is not None
        assert env.spec.max_episode_steps == 7


def test_actions_of_another_shape_are_refused_with_the_right_one() -> None:
    env = gymnasium.make("RobotKit/Wheelchairs-v0")
    env.reset(seed=1)
    with pytest.raises(ValueError, match=r"\(1, 2\), not \(1,\)"):
        env.step(0)
    worlds = gymnasium.make_vec("RobotKit/Turn-v0", num_envs=3, task="smooth-turn")
    worlds.reset(seed=1)
    with pytest.raises(ValueError, match=r"\(3, 2\), not \(3, 1\)"):
        worlds.step(np.zeros((3, 1)))


def test_a_copy_of_an_environment_goes_on_the_same() -> None:
    import copy
    import pickle

    for env in (gymnasium.make("RobotKit/Turn-v0"), BatchVectorEnv(N, QUICK)):
        env.reset(seed=1)
        copies = [env, pickle.loads(pickle.dumps(env)), copy.deepcopy(env)]
        for _ in range(STEPS):
            action = env.action_space.sample()
            first, *others = (each.step(action) for each in copies)
            for other in others:
                assert_same(first, other, "a copy")


@pytest.mark.parametrize("name", ["Turn", "Hallway", "Wheelchairs"])
def test_gymnasium_makes_it(name: str) -> None:
    env = gymnasium.make_vec(f"RobotKit/{name}-v0", num_envs=3)
    observations, _ = env.reset(seed=1)
    assert env.observation_space.contains(observations)
    step = env.step(env.action_space.sample())
    assert env.observation_space.contains(step[0])
    assert [part.shape for part in step[1:4]] == [(3,)] * 3


def test_the_worlds_can_be_of_one_case_and_of_a_task_by_name() -> None:
    env = gymnasium.make_vec("RobotKit/Turn-v0", num_envs=2, task="smooth-turn", case="turn_b_to_a")
    assert isinstance(env, BatchVectorEnv)
    assert [case.name for case in env.batch.cases] == ["turn_b_to_a"]
    assert env.single_action_space.shape == (2,)
