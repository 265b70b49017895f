"""The names that ``import kit`` offers: what they are, that their examples run, and what importing them costs."""

from __future__ import annotations

import doctest
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

import kit
from kit.help.topic import find_topic
from kit.learning.policies.policy import ActionSampling, Policy, task_interface
from kit.learning.policies.policy_file import save_policy
from kit.learning.policies.policy_network import LinearLayer, PolicyNetwork
from kit.learning.tasks.task_spec import TaskSpec

ROOT = Path(__file__).parent.parent


def run_python(program: str, *, folder: Path = ROOT) -> str:
    """Runs a program in a fresh process with this checkout, and returns what it printed."""
    return subprocess.run(
        [sys.executable, "-c", f"import sys; sys.path.insert(0, {str(ROOT)!r})\n{program}"],
        check=True,
        capture_output=True,
        text=True,
        cwd=folder,
    ).stdout.strip()


def test_the_page_explains_exactly_the_public_names() -> None:
    chapters = [each.title for each in find_topic("python").document().chapters]
    assert [each for each in chapters if each.startswith("kit.")] == [f"kit.{name}" for name in kit.__all__]


def test_every_public_name_is_listed_and_resolves() -> None:
    assert list(kit.__all__) == sorted(kit.__all__)
    assert set(kit.__all__) <= set(dir(kit))
    for name in kit.__all__:
        assert getattr(kit, name).__name__ == name
        assert getattr(kit, name) is getattr(kit, name)
    with pytest.raises(AttributeError, match="no_such_name"):
        kit.no_such_name  # noqa: B018 - to look it up is the test


def test_importing_the_kit_loads_nothing_heavy() -> None:
    heavy = ("gymnasium", "torch", "numba", "textual", "numpy", "pymunk", "stable_baselines3")
    assert run_python(f"import kit; print([name for name in {heavy!r} if name in sys.modules])") == "[]"


@pytest.mark.long
def test_reading_a_map_loads_no_learner_and_no_screen() -> None:
    program = "import kit; kit.find_map('maze'); print([n for n in ('gymnasium', 'torch', 'textual') if n in sys.modules])"
    assert run_python(program) == "[]"


@pytest.mark.long
@pytest.mark.parametrize(
    "imports", ["kit, gymnasium", "gymnasium, kit", "kit, kit, gymnasium.envs.registration"]
)
def test_gymnasium_makes_the_environments(imports: str) -> None:
    program = f"""
import {imports}
import gymnasium
for name in ("Turn", "Hallway", "Wheelchairs"):
    env = gymnasium.make(f"RobotKit/{{name}}-v0")
    many = gymnasium.make_vec(f"RobotKit/{{name}}-v0", num_envs=2, vectorization_mode="vector_entry_point")
    env.reset(seed=0), many.reset(seed=0)
    print(type(env.unwrapped).__name__, type(many).__name__)
"""
    expected = [f"{name}Env {name}VectorEnv" for name in ("Turn", "Hallway", "Wheelchairs")]
    assert run_python(program).splitlines() == expected


@pytest.mark.long
def test_registering_twice_warns_of_nothing() -> None:
    """An installed entry point may have registered the environments already."""
    program = """
import warnings
warnings.simplefilter("error")
import gymnasium, kit
from kit.environment_ids import register
register()
print(sum(name.startswith("RobotKit/") for name in gymnasium.registry))
"""
    assert run_python(program) == "3"


@pytest.fixture(scope="module")
def examples_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the policy that the examples name."""
    folder = tmp_path_factory.mktemp("examples")
    layers = (LinearLayer(np.zeros((9, 3), np.float32), np.array([1, 0, 0], np.float32)),)
    network = PolicyNetwork(layers, "tanh")
    save_policy(
        Policy(
            network,
            (3,),
            ActionSampling("softmax"),
            TaskSpec("turn"),
            0,
            task_interface(TaskSpec("turn").resolve()),
        ),
        folder / "best.npz",
    )
    return folder


@pytest.mark.long
@pytest.mark.skipif(find_spec("torch") is None, reason="the extra learn is not installed")
def test_the_examples_of_the_kit_itself_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    example = doctest.DocTestParser().get_doctest(kit.__doc__ or "", {}, "kit", None, 0)
    assert len(example.examples) > 10
    printed: list[str] = []
    assert doctest.DocTestRunner().run(example, out=printed.append).failed == 0, "".join(printed)


@pytest.mark.parametrize("name", kit.__all__)
def test_the_example_in_each_docstring_runs(
    name: str, examples_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(examples_folder)
    doc = getattr(kit, name).__doc__
    example = doctest.DocTestParser().get_doctest(doc, {"kit": kit}, name, None, 0)
    assert example.examples
    printed: list[str] = []
    result = doctest.DocTestRunner().run(example, out=printed.append)
    assert result.failed == 0, "".join(printed)
