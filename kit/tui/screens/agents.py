"""The trained agents to choose from, as lines of a list."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from kit.tui.screens.picker import PickerItem


def agent_items(runs: Path, before: str = "") -> list[PickerItem]:
    """The trainings that have left a policy, the one begun last first, with what they were trained on and how often they arrive
    in their worst case. In another thread: files may be far away. ``before``: what their keys begin with."""
    from kit.learning.training.run_config import RunError
    from kit.learning.training.run_folders import list_runs
    from kit.learning.training.run_text import success_shares

    items = []
    for run in list_runs(runs):
        with suppress(RunError, OSError):
            if not (run.best_policy.exists() or run.newest_policy.exists()):
                continue
            text, best = f"agent: {run.config().choice.title}", run.summary().best_evaluation
            if best is not None:
                text += f", {min(success_shares(best).values()):.0%} arrive in its worst case"
            items.append(PickerItem(f"{before}{run.name}", run.name, text))
    return items
