"""The three drive modes as scripts: at this time this key, then these messages and strengths."""

from __future__ import annotations

import pytest

from kit.tui.input.drive import KeyboardDrive, ModeName, automatic_mode
from kit.tui.input.modes import BRIDGE
from tests.cases import every_case

Step = tuple[float, str, list[str], dict[str, float]]
"""Seconds, what happens, the messages it causes, and what is held afterwards."""


class Script:
    """A drive on a clock of its own."""

    def __init__(self, mode: ModeName) -> None:
        self.now = 0.0
        self.drive = KeyboardDrive(lambda: self.now)
        self.drive.choose(mode)

    def play(self, steps: list[Step]) -> None:
        for time, what, messages, held in steps:
            self.now = time
            verb, _, key = what.partition(" ")
            caused = getattr(self.drive, verb)(*[key] if key else [])
            assert list(caused) == messages, f"messages at {time} after {what}"
            assert dict(self.drive.state.held) == pytest.approx(held), f"held at {time} after {what}"


EXACT: dict[str, list[Step]] = {
    "hold": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (9.0, "repeat w", [], {"up": 1}),
        (99.0, "tick", [], {"up": 1}),
        (99.1, "release w", ["r_up"], {}),
    ],
    "a chord": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (0.1, "press a", ["p_left"], {"up": 1, "left": 1}),
        (0.2, "release w", ["r_up"], {"left": 1}),
        (0.3, "release a", ["r_left"], {}),
    ],
    "two keys of one name": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (0.1, "press up", [], {"up": 1}),
        (0.2, "release w", [], {"up": 1}),
        (0.3, "release up", ["r_up"], {}),
    ],
    "opposite keys are both down": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (0.1, "press s", ["p_down"], {"up": 1, "down": 1}),
        (0.2, "release w", ["r_up"], {"down": 1}),
    ],
    "shift changes on the way": [
        (0.0, "press W", ["p_up"], {"up": 1}),
        (0.1, "release w", ["r_up"], {}),
        (0.2, "press left_shift", ["p_shift_l"], {"shift_l": 1}),
        (0.3, "release left_shift", ["r_shift_l"], {}),
    ],
    "space stops what is held until it is pressed again": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (0.1, "press space", ["r_up", "p_space"], {"space": 1}),
        (0.2, "repeat w", [], {"space": 1}),
        (0.3, "release space", ["r_space"], {}),
        (0.4, "repeat w", [], {}),
        (0.5, "release w", [], {}),
        (0.6, "press w", ["p_up"], {"up": 1}),
    ],
    "stop": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (0.0, "press q", ["p_q"], {"up": 1, "q": 1}),
        (0.1, "stop", ["r_up", "r_q"], {}),
        (0.2, "release w", [], {}),
    ],
    "a key that does not drive": [(0.0, "press k", [], {}), (0.1, "release k", [], {})],
}

FIRST = 1.15 * 0.5 + 0.06
"""Seconds until a press that does not repeat counts as released, with a keyboard not yet known."""
LATER = 2 * 0.06 + 4 * 0.01 + 0.02

REPEAT: dict[str, list[Step]] = {
    "a tap nudges, then bridges, then ends": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (0.149, "tick", [], {"up": 1}),
        (0.151, "tick", [], {"up": BRIDGE}),
        (FIRST - 0.001, "tick", [], {"up": BRIDGE}),
        (FIRST + 0.001, "tick", ["r_up"], {}),
    ],
    "a hold": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (0.3, "tick", [], {"up": BRIDGE}),
        (0.5, "press w", [], {"up": 1}),
        (0.56, "press w", [], {"up": 1}),
        (0.56 + LATER - 0.01, "tick", [], {"up": 1}),  # the even repeats have taken 2 ms off the timeout
        (0.56 + LATER + 0.001, "tick", ["r_up"], {}),
    ],
    "a chord: the first key lives as long as the second": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (0.1, "press a", ["p_left"], {"up": 1, "left": 1}),
        (0.3, "tick", [], {"up": 1, "left": BRIDGE}),
        (0.6, "press a", [], {"up": 1, "left": 1}),
        (0.66, "press a", [], {"up": 1, "left": 1}),
        (0.66 + LATER + 0.001, "tick", ["r_up", "r_left"], {}),
    ],
    "a chord back and forth": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (0.1, "press a", ["p_left"], {"up": 1, "left": 1}),
        (0.2, "press w", [], {"up": 1, "left": 1}),
        (0.2 + LATER + 0.001, "tick", ["r_up", "r_left"], {}),
    ],
    "two taps in a row are no chord": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (0.4, "press a", ["p_left"], {"up": BRIDGE, "left": 1}),
        (FIRST + 0.001, "tick", ["r_up"], {"left": BRIDGE}),
        (0.4 + FIRST + 0.001, "tick", ["r_left"], {}),
    ],
    "a button does not lose the way": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (0.1, "press f", ["p_f"], {"up": 1, "f": 1}),
        (0.1 + FIRST + 0.001, "tick", ["r_up", "r_f"], {}),
    ],
    "the opposite key stops at once, and drives if it is held": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (0.1, "press s", ["r_up"], {}),
        (0.4, "tick", [], {}),
        (0.6, "press s", ["p_down"], {"down": 1}),
        (0.66, "press s", [], {"down": 1}),
        (1.0, "tick", ["r_down"], {}),
    ],
    "there and back again": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (0.1, "press s", ["r_up"], {}),
        (0.2, "press w", ["p_up"], {"up": 1}),
    ],
    "the opposite key leaves the other axis alone": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (0.1, "press a", ["p_left"], {"up": 1, "left": 1}),
        (0.15, "press d", ["r_left"], {"up": 1}),
    ],
    "space stops at once": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (0.1, "press a", ["p_left"], {"up": 1, "left": 1}),
        (0.2, "press space", ["r_up", "r_left", "p_space"], {"space": 1}),
        (0.2 + FIRST + 0.001, "tick", ["r_space"], {}),
    ],
    "time passes unwatched": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (5.0, "press w", ["r_up", "p_up"], {"up": 1}),
    ],
    "stop, and what is still on its way counts as new": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (0.1, "stop", ["r_up"], {}),
        (0.2, "press w", ["p_up"], {"up": 1}),
    ],
    "a release, where one comes": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (0.1, "press a", ["p_left"], {"up": 1, "left": 1}),
        (0.2, "release a", ["r_up", "r_left"], {}),
    ],
    "arrow and letter are one": [
        (0.0, "press w", ["p_up"], {"up": 1}),
        (0.1, "press up", [], {"up": 1}),
        (0.1 + LATER + 0.001, "tick", ["r_up"], {}),
    ],
}

LATCH: dict[str, list[Step]] = {
    "steps add up to full": [
        (0.0, "press w", ["p_up"], {"up": 0.25}),
        (1.0, "press w", [], {"up": 0.5}),
        (2.0, "press w", [], {"up": 0.75}),
        (3.0, "press w", [], {"up": 1}),
        (4.0, "press w", [], {"up": 1}),
        (99.0, "tick", [], {"up": 1}),
    ],
    "S takes what W gave": [
        (0.0, "press w", ["p_up"], {"up": 0.25}),
        (1.0, "press s", ["r_up"], {}),
        (2.0, "press s", ["p_down"], {"down": 0.25}),
    ],
    "turning has two steps, beside driving": [
        (0.0, "press w", ["p_up"], {"up": 0.25}),
        (1.0, "press a", ["p_left"], {"up": 0.25, "left": 0.5}),
        (2.0, "press left", [], {"up": 0.25, "left": 1}),
        (3.0, "press d", [], {"up": 0.25, "left": 0.5}),
    ],
    "space stops": [
        (0.0, "press w", ["p_up"], {"up": 0.25}),
        (1.0, "press a", ["p_left"], {"up": 0.25, "left": 0.5}),
        (2.0, "press space", ["r_up", "r_left", "p_space"], {"space": 1}),
        (2.2, "tick", ["r_space"], {}),
    ],
    "a held key is not a row of presses": [
        (0.0, "press w", ["p_up"], {"up": 0.25}),
        (0.03, "press w", [], {"up": 0.25}),
        (0.06, "press w", [], {"up": 0.25}),
        (0.5, "repeat w", [], {"up": 0.25}),
        (0.6, "release w", [], {"up": 0.25}),
    ],
    "stop": [(0.0, "press w", ["p_up"], {"up": 0.25}), (1.0, "stop", ["r_up"], {})],
    "a button is tapped": [(0.0, "press q", ["p_q"], {"q": 1}), (0.2, "tick", ["r_q"], {})],
}  # fmt: skip


@every_case("story", EXACT)
def test_exact(story: str) -> None:
    Script("exact").play(EXACT[story])


@every_case("story", REPEAT)
def test_repeat(story: str) -> None:
    Script("hold").play(REPEAT[story])


@every_case("story", LATCH)
def test_latch(story: str) -> None:
    Script("latch").play(LATCH[story])


@pytest.mark.parametrize(
    ("mode", "stories"),
    [("exact", EXACT), ("hold", REPEAT), ("latch", LATCH)],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_every_press_message_has_its_release(mode: ModeName, stories: dict[str, list[Step]]) -> None:
    """Whoever listens to messages alone must never be left with a robot that runs."""
    for steps in stories.values():
        script, messages = Script(mode), []
        for time, what, *_ in steps:
            script.now = time
            verb, _, key = what.partition(" ")
            messages += getattr(script.drive, verb)(*[key] if key else [])
        messages += script.drive.stop()
        down: set[str] = set()
        for message in messages:
            kind, name = message[0], message[2:]
            assert (name in down) == (kind == "r"), messages
            (down.add if kind == "p" else down.remove)(name)
        assert down == set()


def test_the_deadline_says_when_to_look_again() -> None:
    script = Script("hold")
    assert script.drive.deadline is None
    script.play([(10.0, "press w", ["p_up"], {"up": 1})])
    assert script.drive.deadline == pytest.approx(10.15)
    script.play([(10.15, "tick", [], {"up": BRIDGE})])
    assert script.drive.deadline == pytest.approx(10 + FIRST)
    script.play([(10 + FIRST, "tick", ["r_up"], {})])
    assert script.drive.deadline is None


def test_the_strengths_add_up_to_a_push() -> None:
    script = Script("exact")
    script.drive.press("w")
    script.drive.press("a")
    assert (script.drive.state.linear, script.drive.state.angular) == (1, 1)
    script.drive.press("s")
    script.drive.press("q")
    assert (script.drive.state.linear, script.drive.state.angular) == (0, 1)


@every_case(
    ("flags", "hidden_by", "mode", "says"),
    [
        (27, None, "exact", "reports"),
        (31, "tmux", "exact", "reports"),
        (25, None, "hold", "this terminal"),
        (2, None, "hold", "this terminal"),
        (None, None, "hold", "this terminal"),
        (None, "tmux", "hold", "tmux"),
        (None, "mosh", "hold", "mosh"),
    ],
)
def test_the_automatic_mode(flags: int | None, hidden_by: str | None, mode: str, says: str) -> None:
    choice = automatic_mode(flags, hidden_by)
    assert choice.mode == mode
    assert says in choice.reason


def test_a_wish_beats_the_terminal_and_can_be_taken_back() -> None:
    drive = KeyboardDrive(lambda: 0.0)
    assert drive.choice.mode == "hold"
    drive.choose("latch")
    drive.terminal_answered(27)
    assert drive.choice.mode == "latch"
    drive.choose(None)
    assert drive.choice.mode == "exact"


def test_a_change_of_mode_stops_and_no_change_does_not() -> None:
    drive = KeyboardDrive(lambda: 0.0)
    assert drive.press("w") == ("p_up",)
    assert drive.terminal_answered(None) == ()
    assert drive.terminal_answered(27) == ("r_up",)
    assert drive.press("w") == ("p_up",)
    assert drive.choose("exact") == ()


@pytest.mark.parametrize("flags", [27, None])
@pytest.mark.parametrize("hidden_by", [None, "screen"])
@pytest.mark.parametrize("wish", [None, "exact", "hold", "latch"])
def test_the_status_is_one_line_that_fits(
    flags: int | None, hidden_by: str | None, wish: ModeName | None
) -> None:
    drive = KeyboardDrive(lambda: 0.0)
    lines = [drive.status]
    drive.terminal_answered(flags, hidden_by)
    drive.choose(wish)
    lines.append(drive.status)
    for line in lines:
        assert line.partition(":")[0] in ("exact", "hold", "latch")
        assert len(line) <= 78
        assert "\n" not in line
