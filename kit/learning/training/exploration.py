"""Boltzmann exploration for the deep Q-network, as the dissertation's agent explored (section 3.1.3)."""

from __future__ import annotations

from typing import Any

import numpy as np
import torch
from stable_baselines3 import DQN
from torch.nn import functional

MAX_EXPONENT = 500.0
"""Values over temperature are kept within this, so that no exponential overflows."""


class BoltzmannDQN(DQN):
    """A DQN that draws actions in proportion to exp(value / temperature), and learns from squared errors.

    With rewards in the hundreds and temperature 1 this explores little: a difference of a few units in value already
    makes the better action all but certain. Keras-RL's defaults are meant, which the dissertation used: squared
    instead of Huber's loss, unbounded gradients. ``temperature`` > 0.
    """

    def __init__(self, *args: Any, temperature: float = 1.0, **settings: Any) -> None:
        self.temperature = temperature
        super().__init__(*args, **settings)

    def predict(
        self,
        observation: Any,
        state: Any = None,
        episode_start: Any = None,
        deterministic: bool = False,
    ) -> tuple[Any, Any]:
        """Actions for observations (n, size); the best ones, or drawn."""
        if deterministic:
            best: tuple[Any, Any] = super().predict(observation, state, episode_start, deterministic=True)
            return best
        batch = np.atleast_2d(observation)
        with torch.no_grad():
            values = self.q_net(torch.as_tensor(batch, device=self.device))
            chances = functional.softmax(
                (values / self.temperature).clamp(-MAX_EXPONENT, MAX_EXPONENT), dim=1
            )
            drawn = torch.multinomial(chances, 1)[:, 0].cpu().numpy()
        return (drawn if np.ndim(observation) == 2 else drawn[0]), state

    def train(self, gradient_steps: int, batch_size: int = 100) -> None:
        """One step of gradient descent on squared temporal differences, ``gradient_steps`` times."""
        self.policy.set_training_mode(True)
        self._update_learning_rate(self.policy.optimizer)
        for _ in range(gradient_steps):
            seen = self.replay_buffer.sample(batch_size, env=self._vec_normalize_env)
            with torch.no_grad():
                best_next = self.q_net_target(seen.next_observations).max(dim=1, keepdim=True).values
                wanted = seen.rewards + (1 - seen.dones) * self.gamma * best_next
            values = self.q_net(seen.observations).gather(1, seen.actions.long())
            self.policy.optimizer.zero_grad()
            functional.mse_loss(values, wanted).backward()
            self.policy.optimizer.step()
        self._n_updates += gradient_steps
