"""Runs the world that a launch file asked for, as a session.

A module of its own because it imports the physics, which a launch without a world does not need.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from kit.launch.launch_run import Launch
from kit.run.scenario import scenario_in_file
from kit.run.session import Session


class LaunchSession(Session):
    """A session in whose ticks the launch takes part; closing it ends the launch. Raises WorldError, OSError."""

    def __init__(
        self,
        launch: Launch,
        *,
        seed: int = 0,
        always_scan: bool = False,
        offered_truths: frozenset[str] | None = None,
    ) -> None:
        request = launch.world
        assert request is not None, "a launch without a world"
        file = request.path.absolute()
        scenario = scenario_in_file(file, _root(file, launch.target.folder))
        super().__init__(
            replace(scenario, title=launch.target.name),
            seed=seed,
            step_size=request.step_size,
            always_scan=always_scan,
            graph=launch.graph,
            offered_truths=offered_truths,
        )
        self.launch = launch
        self.additions = launch.additions
        self.runner.participants.append(launch)

    def reset(self, seed: int | None = None) -> None:
        """Resets the world; the programs go on."""
        self.runner.call_service("reset", seed)

    def close(self) -> None:
        self.launch.close()
        super().close()


def _root(file: Path, package: Path) -> Path:
    """The folder below which the world's files may name other files: their package."""
    folders = [package, *(parent for parent in file.parents if (parent / "package.xml").is_file())]
    return next((folder for folder in folders if file.is_relative_to(folder)), file.parent)
