"""The replay of a league's match, with both robots: who is who, how it stands, and how it ended."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from kit.arrays import FloatArray
from kit.document.rows import Row, row, row_width
from kit.render.roles import Role
from kit.render.scene import Scene, SceneMark
from kit.run.recording import Recording
from kit.run.scenario import Scenario
from kit.run.view import View
from kit.school.game.ghosts import Ghost, GhostComparison
from kit.school.game.league.league_blocks import result_sentence
from kit.school.game.league.standings import Match, MatchFilm
from kit.school.game.league.tag_game import TOLD_TICKS, tag_scenario
from kit.school.game.starts import STARTS, film_scenario
from kit.school.game.two_players import SharedGameState, SharedMode
from kit.tui.rows.shared_game_rows import players_card
from kit.tui.screens.lesson_drive import ReplayScreen
from kit.tui.screens.level_pictures import ghost_paths
from kit.tui.theme import Theme

LEVEL_S: Final = 0.05
"""Two that are so near in time are level [s]."""


class MatchReplayScreen(ReplayScreen):
    """One of the two is the robot, the other has a letter: in a race, where each has driven alone, on a dotted way."""

    has_card = True

    def __init__(self, theme: Theme, match: Match, film: MatchFilm) -> None:
        names = tuple(each.name for each in match.entrants)
        self._match = match
        self._film = film
        self._shows_card = True
        """Whether there was room for the players below the robot's figures."""
        if match.is_tag:
            self._robot = 0
            place, recording = tag_scenario(match.level), film.recordings[0]
            case = None if place.case is None else replace(place.case, name=match.level.title)
            place = replace(place, case=case)
        else:  # the longer drive, so that both are seen to their end
            self._robot = int(film.recordings[1].ticks > film.recordings[0].ticks)
            recording = film.recordings[self._robot]
            place = film_scenario(match.level, recording.seed)
        super().__init__(theme, place, recording, f"{names[0]} against {names[1]}")
        self._driven, self._lettered = names[self._robot], names[1 - self._robot]
        self._ghosts = () if match.is_tag else (self._ghost_of(film.recordings[1 - self._robot], place),)
        self._way = tuple(path for ghost in self._ghosts for path in ghost_paths(ghost))
        self._behind = [
            each for ghost in self._ghosts for each in times_behind(recording.track(place.partners[0]), ghost)
        ]
        """Of a race: by how much the robot is behind [s], every ``TOLD_TICKS`` ticks; None away from the other's way."""

    def _ghost_of(self, drive: Recording, place: Scenario) -> Ghost:
        tracks = tuple(drive.track(robot) for robot in place.partners) if drive.ticks else ()
        return Ghost(self._lettered, drive.ticks * drive.step_size, tracks, drive.step_size)

    @property
    def _letter(self) -> str:
        return self._lettered[:1].upper()

    def _state(self, tick: int) -> SharedGameState | None:
        """Of tag: how it stood at a tick."""
        states = self._film.states
        if not states:
            return None
        names = tuple(each.name for each in self._match.entrants)
        return replace(states[min(tick // TOLD_TICKS, len(states) - 1)], names=names)

    def _panel_rows(self, view: View) -> tuple[Row, ...]:
        """Of tag the players first, as in a game that is played, and the first robot's figures where there is room for both."""
        rows = super()._panel_rows(view)
        panel = self._rows("panel").content_size
        return rows if self._shows_card else tuple(self._card(panel.width - 1, panel.height))

    def _card(self, width: int, room: int) -> list[Row]:
        state = None if self.view is None else self._state(self.view.tick)
        if state is None:
            return []
        card = players_card(SharedMode.TAG, state, None, width)
        self._shows_card = len(card) <= room
        return card if self._shows_card else []

    def message_rows(self, view: View) -> tuple[Row, ...]:
        first, second = ("1", "2") if self._match.is_tag else ("the robot", f"the letter {self._letter}")
        who = row(f" {first}: ", (self._driven, "bold"), f"   {second}: ", (self._lettered, "bold"))
        if view.tick < self._recording.ticks:
            return who, row(f" {self._standing(view)}")
        counts = "" if self._match.is_tag else f"   the middle of {STARTS} drives counts, this is one"
        ended = row((f" {result_sentence(self._match)}", "good"))
        has_room = row_width(who) + len(counts) <= self.size.width
        return (*who, (counts, "dim")) if has_room else who, ended

    def _standing(self, view: View) -> str:
        """Who is ahead at this instant."""
        state = self._state(view.tick)
        if state is not None:
            penalties = ", ".join(
                f"{name}: {score:.1f} s penalty"
                for score, name in zip(state.scores, state.names, strict=True)
            )
            return f"{state.names[state.catcher or 0]} catches; {penalties}"
        behind = self._behind[min(view.tick // TOLD_TICKS, len(self._behind) - 1)] if self._behind else None
        if behind is None:
            return "They drive different ways."
        if abs(behind) < LEVEL_S:
            return "They are level."
        return f"{self._lettered if behind > 0.0 else self._driven} leads by {abs(behind):.2f} s"

    def _view_arrived(self, view: View) -> None:
        if self._match.is_tag:  # there is no target to drive to
            bodies = tuple(each for each in view.scene.bodies if not each.is_target)
            scene = replace(view.scene, targets=(), bodies=bodies)
            view = replace(view, scene=scene, metrics=replace(view.metrics, target_m=None, reached_s=None))
        super()._view_arrived(view)

    def _newest_scene(self) -> Scene:
        scene = super()._newest_scene()
        if self.view is None:
            return scene
        marks = [
            SceneMark(x, y, self._letter, Role.GHOST_OTHER)
            for ghost in self._ghosts
            for x, y, _ in ghost.poses_at(self.view.time_s)
        ]
        return replace(scene, paths=(*self._way, *scene.paths), marks=(*scene.marks, *marks))


def times_behind(track: FloatArray, ghost: Ghost) -> list[float | None]:
    """By how much a drive, ``track`` (ticks, 3), is behind a ghost [s], every ``TOLD_TICKS`` ticks; None away from its way."""
    comparison = GhostComparison(ghost)
    return [
        comparison.update(tick * ghost.step_size, float(track[tick, 0]), float(track[tick, 1]))
        for tick in range(0, len(track), TOLD_TICKS)
    ]
