"""The card of a drive: its path in dots, its time and its medal, as text to share."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from kit.render.encode import BrailleEncoder
from kit.render.scene import Disc, Scene, SceneMark, ScenePath
from kit.render.world_text import scene_rows
from kit.workspace import Workspace, write_atomically

if TYPE_CHECKING:
    from kit.run.recording import Recording
    from kit.school.game.levels import GameLevel
    from kit.school.game.medals import Medal
    from kit.school.game.race import DriverKind, RaceFinish

COLUMNS, ROWS = 48, 14
STYLES = {"keys": "by hand", "controller": "by my program", "agent": "by my agent"}


def card_rows(
    level: GameLevel, driver: DriverKind, finish: RaceFinish, medal: Medal, recording: Recording
) -> list[str]:
    """The rows of the card, at most ``COLUMNS`` wide."""
    scenario = level.find_scenario()
    walls = [layer.walls.segments for layer in scenario.world.layers if layer.walls is not None]
    case = scenario.case
    tracks = [recording.track(name)[::5, :2] for name in scenario.partners]
    scene = Scene(
        walls=np.concatenate(walls),
        paths=tuple(ScenePath(track) for track in tracks if len(track) > 1),
        targets=() if case is None else (Disc(*case.target, case.target_radius),),
        marks=tuple(SceneMark(start.x, start.y, "S") for start in scenario.starts[:1]),
    )
    head = f"{level.title}  {finish.seconds:.2f} s  {medal.title}"
    return [
        head,
        f"robot learning kit, {STYLES[driver.value]}",
        *scene_rows(scene, COLUMNS, ROWS, BrailleEncoder()),
    ]


def save_card(workspace: Workspace, level: GameLevel, driver: DriverKind, rows: list[str]) -> Path:
    """Writes a card as a text file into the workspace. Raises OSError."""
    folder = workspace.folder / "cards"
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / f"{level.id}.{driver.value}.txt"
    write_atomically(file, ("\n".join(rows) + "\n").encode())
    return file
