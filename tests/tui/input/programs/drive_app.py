"""An app with one screen that drives and one that does not; it reports what arrives, and ends as it is told.

Told by keys: 1 raises an exception, 2 raises SystemExit, 3 exits, 4 opens the other screen, 0 one more that
drives, 5 closes it, 6 asks for the cursor's position, 7 draws without end, 8 lets the terminal be used by others
for a moment.
"""

from __future__ import annotations

import json
import os

from textual import events
from textual.app import App, ComposeResult
from textual.screen import Screen
from textual.widgets import Static

from kit.tui.input.drive import DriveState
from kit.tui.input.driver import KeyDriver
from kit.tui.input.key_parser import KeyboardAnswer
from kit.tui.input.modes import KeyEventKind
from kit.tui.input.screen import DriveScreen


def report(*what: object) -> None:
    os.write(int(os.environ["REPORT"]), json.dumps(what).encode() + b"\n")


class Driving(DriveScreen):
    def compose(self) -> ComposeResult:
        yield Static("driving", id="picture")

    def key_received(self, kind: KeyEventKind | None, key: str, messages: tuple[str, ...]) -> None:
        report("timeout" if kind is None else kind.name.lower(), key, *messages)

    def drive_keys_changed(self, messages: tuple[str, ...], state: DriveState) -> None:
        if not messages:
            report("strength", dict(state.held))

    def drive_status_changed(self) -> None:
        report("mode", self.drive.choice.mode)

    def on_keyboard_answer(self, event: KeyboardAnswer) -> None:
        report("answer", event.flags)

    def key_7(self) -> None:
        self.set_interval(0.001, lambda: self.query_one("#picture", Static).update(os.urandom(400).hex()))


class Elsewhere(Screen[None]):
    def on_key(self, event: events.Key) -> None:
        report("elsewhere", event.key)


class Program(App[None]):
    def __init__(self) -> None:
        super().__init__(driver_class=KeyDriver)

    def on_mount(self) -> None:
        self.push_screen(Driving())
        self.call_after_refresh(report, "ready")

    def on_app_blur(self) -> None:
        report("blur")

    def on_paste(self, event: events.Paste) -> None:
        report("paste", event.text)

    def on_cursor_position(self, event: events.CursorPosition) -> None:
        report("cursor", event.x, event.y)

    def key_1(self) -> None:
        raise RuntimeError("as told")

    def key_2(self) -> None:
        raise SystemExit(3)

    def key_3(self) -> None:
        self.exit()

    def key_4(self) -> None:
        self.push_screen(Elsewhere())

    def key_0(self) -> None:
        self.push_screen(Driving())

    def key_5(self) -> None:
        self.pop_screen()

    def key_6(self) -> None:
        assert self._driver is not None
        self._driver.write("\x1b[6n")

    def key_8(self) -> None:
        with self.suspend():
            report("suspended")


if __name__ == "__main__":
    Program().run()
