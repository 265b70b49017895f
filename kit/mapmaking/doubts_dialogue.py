"""What on a photographed sheet may be no wall, as a dialogue: one kind of strokes at a time, shown in the drawing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar, Final

import numpy as np

from kit.dialogue.dialogue import Dialogue, DialogueAction, help_action, leave_action
from kit.dialogue.effects import Effect, Leave
from kit.dialogue.screen_action import ScreenAction, digits
from kit.dialogue.shared_actions import ACTIONS
from kit.document.blocks import Block, Choice, Choices, Picture, Text, Tone
from kit.mapmaking.doubts import Doubt, JudgedStrokes
from kit.render.encode import Encoder
from kit.render.scene import CellState, Scene, SceneCells, ScenePath
from kit.render.world_text import scene_rows

ANSWERS: Final = ("no walls: leave them out", "walls: take them too")
"""What may be said of a kind of strokes, by whether it is taken."""
MAX_BOXES: Final = 40
"""Pieces of a sheet that are shown as doubtful."""
PICTURE_COLUMNS: Final = 72
PICTURE_ROWS: Final = 13
"""Of a drawing: with the question and its answers it fits into 24 rows."""


class DoubtsDialogue(Dialogue):
    """Asks of each kind of doubtful strokes whether they are walls; unanswered ones are none."""

    name = "photograph"
    help_title = "What may be no wall"
    help_notes = (
        (
            ("dotted", "boxes around the strokes that are asked about"),
            ("solid", "walls for sure, and what you took for walls"),
            ("overlay.png", "the sheet itself, in the folder of the map"),
        ),
    )

    def __init__(self, strokes: JudgedStrokes, encoder: Encoder) -> None:
        self._strokes = strokes
        self._encoder = encoder
        self._at = 0
        self._taken = [False] * len(strokes.doubts)

    @property
    def kept(self) -> list[str]:
        """The kinds that were said to be walls."""
        return [
            each.kind for each, is_taken in zip(self._strokes.doubts, self._taken, strict=True) if is_taken
        ]

    # What is shown

    @property
    def title(self) -> str:
        return "Walls, or not?"

    @property
    def position(self) -> str:
        return "" if self.is_over else f"question {self._at + 1} of {len(self._strokes.doubts)}"

    @property
    def place(self) -> object:
        return self._at

    @property
    def is_over(self) -> bool:
        return self._at >= len(self._strokes.doubts)

    def blocks(self) -> Sequence[Block]:
        if self.is_over:
            return ()
        doubt, taken = self._strokes.doubts[self._at], self._taken[self._at]
        entries = (
            Choice(str(number), answer, *((Tone.BOLD, ">") if taken == (number == 2) else ()))
            for number, answer in enumerate(ANSWERS, start=1)
        )
        return (
            Text(f"In dotted boxes: {doubt.text}.", Tone.BOLD),
            Picture(self._picture(doubt), is_tight=True),
            Choices(tuple(entries), is_tight=True),
        )

    def _picture(self, doubt: Doubt) -> tuple[str, ...]:
        shown = self._strokes.keeping(self.kept)
        scene = Scene(cells=wall_cells(shown), paths=dotted_boxes(doubt, shown.walls.shape[0]))
        return tuple(scene_rows(scene, PICTURE_COLUMNS, PICTURE_ROWS, self._encoder))

    # What is done

    def answer(self, number: int) -> Effect:
        self._taken[self._at] = number == 2
        return None

    def go_on(self) -> Effect:
        self._at += 1
        return Leave() if self.is_over else None

    def go_back(self) -> Effect:
        self._at -= 1
        return None

    def can_go_back(self) -> bool | str:
        return self._at > 0 or "This is the first question."

    actions: ClassVar[Sequence[DialogueAction[Any]]] = (
        DialogueAction(
            ScreenAction("walls_or_not", "1 2", "answer", "say what the strokes in dotted boxes are", digits("answer", 1, 2), "1-2"),
            answer, then="next",
        ),
        DialogueAction(ACTIONS["next"], go_on),
        DialogueAction(ACTIONS["previous"], go_back, can_go_back),
        help_action(),
        leave_action(),
    )  # fmt: skip


def wall_cells(strokes: JudgedStrokes) -> SceneCells:
    """The walls as cells of one pixel, with the sheet as their floor."""
    states = np.where(strokes.walls[::-1], CellState.OCCUPIED, CellState.FREE).astype(np.uint8)
    return SceneCells(states, (0.0, 0.0), 1.0)


def dotted_boxes(doubt: Doubt, height: int, resolution: float = 1.0) -> tuple[ScenePath, ...]:
    """Boxes around the largest pieces, on a sheet ``height`` pixels high, a pixel ``resolution`` [m] wide."""
    boxes = []
    for left, top, right, bottom in doubt.boxes()[:MAX_BOXES]:
        corners = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)]
        points = np.array([(x * resolution, (height - y) * resolution) for x, y in corners])
        boxes.append(ScenePath(points, "dotted"))
    return tuple(boxes)
