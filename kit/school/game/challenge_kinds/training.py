"""Train within a budget: an agent that succeeds often enough after few steps."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Self

from kit.school.game.challenge import AnswerError, AnswerSubmission, ChallengeTask
from kit.school.game.judgement import AnswerComparison, Judgement
from kit.school.game.medal import Medal
from kit.world.yaml_section import Section

GOLD_STEPS: Final = 0.35
"""Share of the budget of training steps that earns gold."""
SILVER_STEPS: Final = 0.6
"""Silver, likewise."""


@dataclass(frozen=True, slots=True)
class TrainingTask(ChallengeTask):
    """A task to train within a budget. The answer is the name of a training run."""

    kind = "training"

    trains: str
    max_steps: int
    success: float
    """Share of the test's episodes."""
    own_reward: bool

    @classmethod
    def read(cls, section: Section, folder: Path) -> Self:
        return cls(
            section.name("trains"),
            section.integer("max_steps", minimum=1, maximum=10**9),
            section.number("success", above=0, maximum=1),
            section.flag("own_reward"),
        )

    @property
    def learning_task(self) -> str:
        return self.trains

    @property
    def rungs(self) -> tuple[tuple[Medal, int], ...]:
        """The steps in which a training earns each medal."""
        shares = ((Medal.BRONZE, 1.0), (Medal.SILVER, SILVER_STEPS), (Medal.GOLD, GOLD_STEPS))
        return tuple((medal, int(share * self.max_steps)) for medal, share in shares)

    def lines(self) -> list[str]:
        """What earns the medals, and the commands for it."""
        rungs = (f"{medal.title:<6} at most {steps:7,} steps" for medal, steps in reversed(self.rungs))
        reward = " --reward FILE" if self.own_reward else ""
        return [
            *rungs,
            "",
            f"kit train {self.trains} --steps N{reward}   trains; it always ends a batch of steps",
            f"kit train {self.trains} --list   names the settings that --set changes",
        ]

    def parse_answer(self, argument: str) -> str:
        return argument  # a run's name, also where a file is called so

    def judge(self, submission: AnswerSubmission) -> Judgement:
        from kit.learning.training.run_config import RunError
        from kit.learning.training.run_folders import find_run
        from kit.learning.training.run_text import success_shares

        name = submission.answer
        try:
            run = find_run(submission.runs, name)
            config, summary = run.config(), run.summary()
        except (RunError, LookupError) as error:
            raise AnswerError(str(error)) from None
        trained = json.dumps(config.choice.as_dict())
        if f'"{self.trains}"' not in trained:
            raise AnswerError(f"{name} trains another task than {self.trains}.")
        best = summary.best_evaluation
        shares = [] if best is None else list(success_shares(best).values())
        success = sum(shares) / len(shares) if shares else 0.0
        return judge_training(self, summary.steps, success, has_own_reward=config.reward_file is not None)


def judge_training(task: TrainingTask, steps: int, success: float, *, has_own_reward: bool) -> Judgement:
    """Judges a training by its steps, its test's successes (0 to 1) and its reward."""
    text = f"{success:.0%} successes after {steps:,} steps."
    if task.own_reward and not has_own_reward:
        return Judgement(Medal.NONE, f"{text} The reward was the kit's: --reward FILE trains with yours.")
    others = (("budget", task.max_steps), ("gold at", int(GOLD_STEPS * task.max_steps)))
    comparison = AnswerComparison("steps", steps, others, task.rungs)
    if success < task.success or steps > task.max_steps:
        text = f"{text} {task.success:.0%} in at most {task.max_steps:,} are asked for."
        return Judgement(Medal.NONE, text, comparison)
    return Judgement(comparison.medal, text, comparison)


KIND = TrainingTask
