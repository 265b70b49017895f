"""Visit all places of a floor with the fewest moves: the order is the puzzle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

from kit.document.blocks import Tone, ToneText
from kit.document.rows import Row, row
from kit.plain_text import counted
from kit.school.game.board import (
    Board,
    Cell,
    cells_of_moves,
    distances_to,
    find_cell,
    grid_rows,
    shortest_way,
    told_rows,
    visit_rows,
    way_signs,
)
from kit.school.game.challenge import AnswerSubmission
from kit.school.game.judgement import Judgement, judge_count
from kit.school.game.medal import Medal
from kit.school.game.moves_challenge import MovesBoard, MovesTask, read_moves

MAX_MOVES = 400


@dataclass(frozen=True, slots=True)
class RoundTask(MovesTask):
    """A floor with places to visit, the lower-case letters, from ``S`` and back."""

    kind = "round"

    def naive_answer(self) -> str:
        return f"{naive_round(self)}\n"

    def board(self, answer: str) -> Board:
        return RoundBoard(self, answer)

    def judge(self, submission: AnswerSubmission) -> Judgement:
        moves = read_moves(submission.answer, MAX_MOVES)
        cell, left = trace_moves(self, moves)
        if left:
            return Judgement(Medal.NONE, f"It does not come to {', '.join(sorted(left))}.")
        if cell != find_cell(self.grid, "S"):
            return Judgement(Medal.NONE, "It comes to all of them, but not home.")
        count, fewest, naive = len(moves), len(best_round(self)), len(naive_round(self))
        text = f"{counted(count, 'move')}; in the order of the letters it takes {naive}, and {fewest} are enough."
        return judge_count("moves", text, count, fewest, naive, near=2)  # every round has an even number

    @property
    def places(self) -> dict[str, Cell]:
        """The places by their letters."""
        return {sign: find_cell(self.grid, sign) for line in self.grid for sign in line if sign.islower()}


def trace_moves(task: RoundTask, moves: str) -> tuple[Cell, set[str]]:
    """Where moves lead to, and the places that they do not come to."""
    home = find_cell(task.grid, "S")
    passed = [home, *cells_of_moves(task.grid, home, moves)]
    return passed[-1], {name for name, place in task.places.items() if place not in passed}


def _moves_through(task: RoundTask, names: str) -> str:
    """The moves from place to place in this order, from the start and home."""
    home = find_cell(task.grid, "S")
    stops = [home, *(task.places[name] for name in names), home]
    return "".join(shortest_way(task.grid, a, b) for a, b in pairwise(stops))


@cache
def naive_round(task: RoundTask) -> str:
    """The round in the order of the letters."""
    return _moves_through(task, "".join(sorted(task.places)))


@cache
def best_round(task: RoundTask) -> str:
    """A round than which none has fewer moves: dynamic programming over the sets of visited places (Held and Karp, 1962)."""
    places, home = task.places, find_cell(task.grid, "S")
    names = sorted(places)
    far = {name: distances_to(task.grid, place) for name, place in places.items()}
    best: dict[tuple[frozenset[str], str], tuple[int, str]] = {
        (frozenset(name), name): (far[name][home], name) for name in names
    }
    for size in range(2, len(names) + 1):
        longer: dict[tuple[frozenset[str], str], tuple[int, str]] = {}
        for (visited, last), (moves, order) in best.items():
            if len(visited) != size - 1:
                continue
            for name in names:
                if name not in visited:
                    key = (visited | {name}, name)
                    found = (moves + far[name][places[last]], order + name)
                    longer[key] = min(longer.get(key, found), found)
        best |= longer
    ends = [
        (moves + far[last][home], order)
        for (visited, last), (moves, order) in best.items()
        if len(visited) == len(names)
    ]
    return _moves_through(task, min(ends)[1])


class RoundBoard(MovesBoard):
    """Arrows walk; places that have been visited become capitals."""

    def __init__(self, task: RoundTask, answer: str) -> None:
        super().__init__(task, answer, MAX_MOVES)
        self._round = task

    def rows(self, scale: int = 1) -> list[Row]:
        task = self._round
        cell, left = trace_moves(task, self.moves)
        places = {
            place: (name, "bold") if name in left else (name.upper(), "good")
            for name, place in task.places.items()
        }
        signs = {**way_signs(task.grid, find_cell(task.grid, "S"), self.moves), **places}
        signs[cell] = ("@", "chosen")
        visited = len(task.places) - len(left)
        return [
            *grid_rows(task.grid, signs, scale),
            row(),
            row(
                (f"  moves {len(self.moves)}", "bold"),
                f"   {visited} of {len(task.places)} places, then home to S",
            ),
        ]

    def details(self, width: int) -> list[list[Row]]:
        """The places in the order in which they were come to, and how often each square was entered."""
        cells = cells_of_moves(self._round.grid, find_cell(self._round.grid, "S"), self.moves)
        reached = sorted(
            (cells.index(place), name) for name, place in self._round.places.items() if place in cells
        )
        legs = [
            (name, number + 1, ToneText(f"+{number - before}", Tone.DIM))
            for (number, name), before in zip(reached, [-1, *(number for number, _ in reached)], strict=False)
        ]
        return [
            told_rows("moves to each letter", legs, width),
            visit_rows(self._round.grid, cells),
            self.moves_made(width),
        ]

    def curve(self) -> tuple[str, Sequence[float]]:
        left, counts = dict.fromkeys(self._round.places.values()), []
        for cell in cells_of_moves(self._round.grid, find_cell(self._round.grid, "S"), self.moves):
            left.pop(cell, None)
            counts.append(len(left))
        return "letters left after each move", counts


KIND = RoundTask
