"""The world that a launch file asked for, as a session like any other."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from kit.launch.launch_run import Launch
from kit.run.scenario import place_in_file
from kit.run.session import Session


class LaunchedSession(Session):
    """The launch takes part in its ticks, and ends with it. Raises WorldError, OSError."""

    def __init__(self, launch: Launch, *, seed: int = 0, watched: bool = False) -> None:
        wanted = launch.world
        assert wanted is not None, "a launch without a world"
        file = wanted.path.absolute()
        place = place_in_file(file, _root(file, launch.target.folder))
        super().__init__(
            replace(place, title=launch.target.name),
            seed=seed,
            step_size=wanted.step_size,
            watched=watched,
            graph=launch.graph,
        )
        self.launch = launch
        self.runner.participants.append(launch)

    def reset(self, seed: int | None = None) -> None:
        """The world back to its start; the programs go on."""
        self.runner.call_service("reset", seed)

    def close(self) -> None:
        self.launch.close()
        super().close()


def _root(file: Path, package: Path) -> Path:
    """What the world's files may name: all of the package they lie in."""
    folders = [package, *(parent for parent in file.parents if (parent / "package.xml").is_file())]
    return next((folder for folder in folders if file.is_relative_to(folder)), file.parent)
