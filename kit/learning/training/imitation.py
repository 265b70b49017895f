"""Learns from examples instead of rewards (needs the extra ``learn``).

Behaviour cloning learns what was done for what was seen (Pomerleau 1989). It fails where it has come off the
demonstrated way, of which there are no examples. DAgger drives with what has been learned so far, asks the demonstrator
what it would have done there, and learns from all examples together (Ross, Gordon and Bagnell 2011).
"""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence

import numpy as np
import torch
from torch import nn
from torch.nn import functional

from kit.arrays import FloatArray
from kit.learning.policies.export import convert_modules
from kit.learning.policies.policy import ActionSampling, Policy, action_counts, task_interface
from kit.learning.policies.seeds import derive_seed
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.algorithm_settings import ImitationParams, LinearSchedule
from kit.learning.training.algorithms import Algorithm
from kit.learning.training.checkpoint_file import LearnerCounts, check_actions, check_rows
from kit.learning.training.demonstrations import DemonstrationError, Demonstrator, Examples, join_examples
from kit.learning.training.learner import TrainingCallback
from kit.learning.training.presets import Preset
from kit.learning.training.torch_parts import TorchParts, pack_parts, unpack_parts

ACTIVATIONS = {"tanh": nn.Tanh, "relu": nn.ReLU}
DEFAULT_RATE = LinearSchedule(1e-3, 1e-4)
RESTORED_RATE = 0.5
"""Factor for the learning rate each time a learner returns to an earlier policy."""


class ImitationLearner:
    """A network that learns to do what demonstrators do. A step is an example that an update has learned from."""

    def __init__(
        self,
        algorithm: Algorithm,
        preset: Preset,
        choice: TaskSpec,
        task: LearningTask,
        seed: int,
        demonstrators: Sequence[Demonstrator],
    ) -> None:
        """DemonstrationError without demonstrators, or if DAgger has one that cannot be asked."""
        if not demonstrators:
            raise DemonstrationError(
                f"{algorithm.name} needs something to imitate: give a recording, a controller, a run or a policy with "
                "--imitate."
            )
        settings = preset.settings
        assert isinstance(settings, ImitationParams)
        if settings.rounds and not all(each.can_be_asked for each in demonstrators):
            raise DemonstrationError(
                "dagger asks the demonstrator in the states that the learner visits, and a recording cannot answer: imitate a "
                "controller, a run or a policy; or take --algo bc."
            )
        torch.set_num_threads(1)
        self._algorithm, self._preset, self._settings = algorithm, preset, settings
        self._choice, self._task, self._seed = choice, task, seed
        self._demonstrators = tuple(demonstrators)
        self._space = task.actions.space(task.robots)
        self._choices = action_counts(self._space)
        torch.manual_seed(seed)
        self._network = _make_network(
            preset, task, sum(self._choices) or int(np.prod(self._space.shape or ()))
        )
        self._optimizer = torch.optim.Adam(self._network.parameters())
        self._rng = np.random.default_rng(derive_seed(seed, "imitation"))
        self._examples: list[Examples] = []
        self._rounds = 0
        self._rate_factor = 1.0
        self.steps = 0

    def learn(self, steps: int, callback: TrainingCallback) -> None:
        settings = self._settings
        while self.steps < steps:
            callback.between_updates()
            if self._rounds <= min(settings.rounds, self.steps // settings.round_steps):
                self._demonstrate()
            examples = join_examples(self._examples)
            self._examples = [examples]
            seen = torch.from_numpy(examples.observations)
            done = torch.from_numpy(np.ascontiguousarray(examples.actions))
            order = self._rng.permutation(len(examples))
            for first in range(0, len(order), settings.batch_size):
                which = order[first : first + settings.batch_size]
                self._update(seen[which], done[which], 1.0 - min(1.0, self.steps / steps))
                self.steps += len(which)

    def _demonstrate(self) -> None:
        """Adds examples: the demonstrators' own ways at first, then what they would do along the learner's."""
        driver = self.policy() if self._rounds else None
        seed = derive_seed(self._seed, "demonstration", self._rounds)
        self._examples += [each.demonstrate(driver, seed) for each in self._demonstrators]
        self._rounds += 1

    def _update(self, seen: torch.Tensor, done: torch.Tensor, left: float) -> None:
        schedule = self._preset.learning_rate or DEFAULT_RATE
        for group in self._optimizer.param_groups:
            group["lr"] = self._rate_factor * schedule.value_at(left)
        outputs = self._network(seen)
        if not self._choices:
            loss = functional.mse_loss(outputs, done)
        else:
            heads = outputs.split(list(self._choices), dim=1)
            chosen = done.reshape(len(done), -1).long()
            loss = sum(functional.cross_entropy(head, chosen[:, number]) for number, head in enumerate(heads))
        self._optimizer.zero_grad()
        loss.backward()
        self._optimizer.step()

    def assign_cases(self, shares: FloatArray) -> None:
        """Demonstrators show every case equally often."""

    def policy(self) -> Policy:
        return Policy(
            convert_modules(self._network),
            self._choices,
            ActionSampling("softmax") if self._choices else ActionSampling("normal", 1.0, self._deviations()),
            self._choice,
            self.steps,
            task_interface(self._task),
        )

    def _deviations(self) -> tuple[float, ...]:
        """How far its continuous actions are from the demonstrators', on average."""
        if not self._examples:
            return (1.0,) * int(self._network[-1].out_features)
        seen, done = self._examples[-1].observations[-5000:], self._examples[-1].actions[-5000:]
        with torch.no_grad():
            apart = self._network(torch.from_numpy(seen)).numpy() - done
        return tuple(np.sqrt(np.square(apart).mean(axis=0)).astype(float).tolist())

    def measures(self) -> dict[str, float]:
        return {}

    def _parts(self) -> TorchParts:
        return {"network": self._network, "optimizer": self._optimizer}

    def snapshot(self) -> bytes:
        return pack_parts({"network": self._network})

    def restore(self, known: bytes) -> None:
        unpack_parts({"network": self._network}, known)
        self._rate_factor *= RESTORED_RATE

    def save(self) -> dict[str, bytes]:
        examples = io.BytesIO()
        known = join_examples(self._examples) if self._examples else None
        counts = LearnerCounts(self._algorithm.name, self.steps, self._rate_factor, rounds=self._rounds)
        parts = {**counts.pack(), "parameters.npz": pack_parts(self._parts())}
        if known is not None:
            np.savez(examples, observations=known.observations, actions=known.actions)
            parts["examples.npz"] = examples.getvalue()
        return parts

    def load(self, parts: Mapping[str, bytes]) -> None:
        counts = LearnerCounts.unpack(parts, self._algorithm.name)
        unpack_parts(self._parts(), parts["parameters.npz"])
        self.steps, self._rounds, self._rate_factor = counts.steps, counts.rounds, counts.slower
        if "examples.npz" in parts:
            with np.load(io.BytesIO(parts["examples.npz"]), allow_pickle=False) as stored:
                self._examples = [self._check_examples(Examples(stored["observations"], stored["actions"]))]

    def _check_examples(self, found: Examples) -> Examples:
        """Those of a checkpoint. ValueError if they are not this task's."""
        count, actions = len(found), np.atleast_2d(found.actions.T).T
        columns = len(self._choices) or int(self._network[-1].out_features)
        check_rows(found.observations, np.zeros((count, self._network[0].in_features), np.float32))
        check_rows(actions, np.zeros((count, columns), np.int64 if self._choices else np.float32))
        for number, choices in enumerate(self._choices):
            check_actions(actions[:, number], choices)
        if not count or len(actions) != count:
            raise ValueError("examples without actions, or none")
        return found


def _make_network(preset: Preset, task: LearningTask, outputs: int) -> nn.Sequential:
    activation = ACTIVATIONS[preset.activation or "tanh"]
    modules: list[nn.Module] = []
    size = task.observation.size * task.robots
    for width in preset.layers:
        modules += [nn.Linear(size, width), activation()]
        size = width
    return nn.Sequential(*modules, nn.Linear(size, outputs))
