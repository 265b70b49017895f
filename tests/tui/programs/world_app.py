"""A robot in a maze, in the terminal: ``p`` pauses and reports what is on the screen, ``z`` follows and zooms,
``q`` quits."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[3]))

from textual.app import App, ComposeResult
from textual.timer import Timer

from kit.tui.input.driver import KeyDriver
from kit.tui.widgets.world_view import WorldView
from tests.render.scenes import drive


def report(*what: object) -> None:
    os.write(int(os.environ["REPORT"]), json.dumps(what).encode() + b"\n")


class Program(App[None]):
    def __init__(self) -> None:
        super().__init__(driver_class=KeyDriver)
        self.theme = "ansi-dark"
        self.view = WorldView()
        self.scenes = drive()
        self.clock: Timer

    def compose(self) -> ComposeResult:
        yield self.view

    def on_mount(self) -> None:
        self.clock = self.set_interval(1 / 20, lambda: self.view.offer(lambda: next(self.scenes)))

    def report_screen(self) -> None:
        frame, lag = self.view.frame, self.view.throttle.lag
        report("screen", frame.rows() if frame else [], self.view.throttle.fps, lag)

    def key_p(self) -> None:
        self.clock.pause()
        self.set_timer(0.3, self.report_screen)

    def key_z(self) -> None:
        self.view.follow()
        self.view.zoom(3)

    def key_q(self) -> None:
        self.exit()


if __name__ == "__main__":
    Program().run()
