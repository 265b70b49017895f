"""Every kind of sequence a terminal sends, through the parser, whole and in pieces."""

from __future__ import annotations

import inspect
import os
import re
import signal
import termios
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import pytest
from textual import events
from textual._xterm_parser import _MAX_SEQUENCE_SEARCH_THRESHOLD, XTermParser
from textual.app import App
from textual.driver import Driver
from textual.drivers import linux_driver
from textual.drivers._writer_thread import WriterThread
from textual.drivers.linux_driver import LinuxDriver

from kit.tui.input.driver import key_driver
from kit.tui.input.key_parser import KeyboardAnswer, KeyParser, KeyReleased, KeyRepeated
from kit.tui.input.protocol import RELEASES_OFF, RELEASES_ON
from kit.tui.input.terminal_guard import FATAL, restore_terminal
from tests.cases import every_case

PRESSES = {
    "w": "w",
    "W": "W",
    " ": "space",
    "\r": "enter",
    "\x03": "ctrl+c",
    "\x1b[A": "up",
    "\x1bOA": "up",
    "\x1b[1;2A": "shift+up",
    "\x1b[1;5D": "ctrl+left",
    "\x1b[97u": "a",
    "\x1b[97;;97u": "a",
    "\x1b[97;2;65u": "A",
    "\x1b[97;5u": "ctrl+a",
    "\x1b[97;1:1;97u": "a",
    "\x1b[97:65;2:1;65u": "A",
    "\x1b[97:65:113;2;65u": "A",
    "\x1b[32;1:1;32u": "space",
    "\x1b[27u": "escape",
    "\x1b[1;1:1A": "up",
    "\x1b[1;2:1C": "shift+right",
    "\x1b[3;1:1~": "delete",
    "\x1b[57441;2u": "left_shift",
    "\x1b[57447;2:1u": "right_shift",
    "\x1b[57442;5:1u": "left_control",
    "\x1b[57448;5:1u": "right_control",
}
RELEASES = {
    "\x1b[119;1:3u": "w",
    "\x1b[119;5:3u": "w",
    "\x1b[119:87;2:3u": "w",
    "\x1b[1;1:3A": "up",
    "\x1b[1;2:3D": "left",
    "\x1b[32;1:3u": "space",
    "\x1b[57441;1:3u": "left_shift",
    "\x1b[57448;1:3u": "right_control",
    "\x1b[27;1:3u": "escape",
    "\x1b[3;1:3~": "delete",
}
REPEATS = {
    "\x1b[119;1:2;119u": ("w", "w"),
    "\x1b[1;1:2B": ("down", None),
    "\x1b[32;1:2;32u": ("space", " "),
    "\x1b[57447;2:2u": ("right_shift", None),
}
ANSWERS = {
    "\x1b[?62;52;c": None,
    "\x1b[?6c": None,
    "\x1b[?1;2c": None,
    "\x1b[?61;4;6;7;14;21;22;23;24;28;32;42;52c": None,
    "\x1b[?64;1;2;6;9;15;16;17;18;21;22;28c": None,
    "\x1b[?0u\x1b[?62c": 0,
    "\x1b[?27u\x1b[?62;c": 27,
    "\x1b[?27u\x1b[?61;4;6;7;14;21;22;23;24;28;32;42;52c": 27,
}


def parse(text: str, *, piecewise: bool = False) -> list[object]:
    """What comes out, and is passed on, when the terminal sends this and then nothing."""
    parser = KeyParser()
    out: list[object] = []
    for piece in text if piecewise else [text]:
        out += parser.feed(piece)
    parser._timeout_time = 0.0 if parser._timeout_time is not None else None
    out += parser.tick()
    return out


def summary(text: str, *, piecewise: bool = False) -> list[object]:
    def one(event: object) -> object:
        match event:
            case KeyReleased():
                return ("up", event.key)
            case KeyRepeated():
                return ("again", event.key, event.character)
            case KeyboardAnswer():
                return ("answer", event.flags)
            case events.Key():
                return ("down", event.key)
        return type(event).__name__

    return [one(event) for event in parse(text, piecewise=piecewise)]


CASES: dict[str, Any] = (
    {text: [("down", key)] for text, key in PRESSES.items()}
    | {text: [("up", key)] for text, key in RELEASES.items()}
    | {text: [("again", *what)] for text, what in REPEATS.items()}
    | {text: [("answer", flags)] for text, flags in ANSWERS.items()}
    | {
        "\x1b[12;34R": ["CursorPosition"],
        "\x1b[I": ["AppFocus"],
        "\x1b[O": ["AppBlur"],
        "\x1b[?2026;2$y": ["TerminalSupportsSynchronizedOutput"],
        "\x1b[200~wasd\x1b[201~x": ["Paste", ("down", "x")],
        "\x1b[<35;10;5M": ["MouseMove"],
        "\x1b[48;24;80;480;800t": ["Resize"],
        "\x1b": [("down", "escape")],
        "\x1b[?31u": [],
        "w\x1b[?62;c\x1b[?27uw": [("down", "w"), ("answer", None), ("down", "w")],
    }
)


@every_case("piecewise", [False, True], ids=["whole", "piecewise"])
@every_case("text", CASES, ids=repr)
def test_a_sequence_becomes_what_it_means(text: str, piecewise: bool) -> None:
    assert summary(text, piecewise=piecewise) == CASES[text]


@every_case("answer", ANSWERS, ids=repr)
def test_an_answer_never_types_and_swallows_nothing_after_it(answer: str) -> None:
    assert summary(answer + "w\x1b[A")[-2:] == [("down", "w"), ("down", "up")]
    assert len(summary(answer + "w\x1b[A")) == 3


def test_a_long_answer_that_breaks_off_does_not_swallow_keys() -> None:
    cut = "\x1b[?61;4;6;7;14;21;22;23;24;28;32;42;5"
    assert summary(cut + "\x1b[A" + "5w") == [("down", "up"), ("down", "5"), ("down", "w")]


def test_a_release_bears_the_name_of_its_press() -> None:
    """Shift+1 types an exclamation mark; when 1 goes up, shift may be long gone."""
    assert summary("\x1b[49;2;33u\x1b[49;2:2;33u\x1b[49;1:3u\x1b[49;1:3u") == [
        ("down", "exclamation_mark"),
        ("again", "exclamation_mark", "!"),
        ("up", "exclamation_mark"),
        ("up", "1"),
    ]
    assert summary("\x1b[A\x1b[1;2:3A") == [("down", "up"), ("up", "up")]


def test_parsers_do_not_share_what_they_remember() -> None:
    """XTermParser caches parsed sequences for the whole process; our events must not be those."""
    assert summary("\x1b[119;1:3u") == summary("\x1b[119;1:3u") == [("up", "w")]
    one, other = parse("\x1b[119;;119u"), parse("\x1b[119;;119u")
    assert one[0] is not other[0]


# What we use of Textual beyond its public names. When one of these fails after an update of Textual, look here.


def test_textual_still_raises_at_event_types() -> None:
    """The reason for KeyParser. If this fails, Textual has learned them: see what can go."""
    with pytest.raises(ValueError, match="1:3"):
        list(XTermParser().feed("\x1b[97;1:3u"))


def test_textual_gives_up_on_a_sequence_beyond_the_threshold() -> None:
    """The reason for the long answer's own path."""
    sequence = "\x1b[?" + "1" * (_MAX_SEQUENCE_SEARCH_THRESHOLD - 3)
    assert not list(XTermParser().feed(sequence))
    assert len(list(XTermParser().feed(sequence + "1"))) > 1


def test_textual_passes_every_sequence_and_character_through_one_method() -> None:
    seen: list[str] = []

    class Spy(XTermParser):
        def _sequence_to_key_events(self, sequence: str, alt: bool = False) -> list[events.Key]:
            seen.append(sequence)
            return []

    list(Spy().feed("w\x1b[1;1:3A"))
    assert seen[0] == "w"
    assert seen[-1] == "\x1b[1;1:3A"


def test_textual_finds_an_escape_key_by_waiting() -> None:
    parser = KeyParser()
    assert list(parser.feed("\x1b")) == []
    end = time.monotonic() + 2
    found: list[object] = []
    while not found and time.monotonic() < end:
        found = list(parser.tick())
    assert isinstance(found[0], events.Key)


Run = Callable[..., Any]
LONG_ATTRIBUTES = b"\x1b[?61;4;6;7;14;21;22;23;24;28;32;42;52c"
"""Windows Terminal's: longer than what Textual's parser looks at."""


@pytest.fixture
def driving(terminal: Run) -> Any:
    """An app on its drive screen, in a terminal that reports releases."""
    made = terminal("drive_app.py")
    made.until_reported(["mode", "exact"])
    return made


def test_keys_arrive_as_presses_repeats_and_releases(driving: Any) -> None:
    """One session, because starting an app takes longer than all keys together."""
    conversation: list[tuple[bytes, list[list[object]]]] = [
        (b"\x1b[119;;119u", [["press", "w", "p_up"]]),
        (b"\x1b[119;1:2;119u", [["repeat", "w"]]),
        (b"\x1b[119;1:3u", [["release", "w", "r_up"]]),
        (b"\x1b[A", [["press", "up", "p_up"]]),
        (b"\x1b[1;1:2A", [["repeat", "up"]]),
        (b"\x1b[1;2:3A", [["release", "up", "r_up"]]),
        (b"\x1b[97;2;65u", [["press", "A", "p_left"]]),
        (b"\x1b[97;1:3u", [["release", "A", "r_left"]]),
        (b"\x1b[57441;2u", [["press", "left_shift", "p_shift_l"]]),
        (b"\x1b[57441;1:3u", [["release", "left_shift", "r_shift_l"]]),
        (b"\x1b[57448;5u", [["press", "right_control", "p_ctrl_r"]]),
        (b"\x1b[57448;1:3u", [["release", "right_control", "r_ctrl_r"]]),
        (b"\x1b[27u", [["press", "escape", "p_esc"]]),
        (b"\x1b[27;1:3u", [["release", "escape", "r_esc"]]),
        (b"\x1b[119;;119u\x1b[32;;32u", [["press", "w", "p_up"], ["press", "space", "r_up", "p_space"]]),
        (b"\x1b[119;1:2;119u", [["repeat", "w"]]),
        (b"\x1b[32;1:3u\x1b[119;1:3u", [["release", "space", "r_space"], ["release", "w"]]),
        (b"k", [["press", "k"]]),
        (b"\x1b[12;34R", [["cursor", 33, 11]]),
        (b"\x1b[54;;54u", [["press", "6"], ["cursor", 33, 11]]),
        (b"\x1b[200~wasd\x1b[201~", [["paste", "wasd"]]),
        (b"\xff\xfe\xc3", []),
        (b"\x1b[119;;119u", [["press", "w", "p_up"]]),
        (b"\x1b[O", [["blur"]]),
        (b"\x1b[I\x1b[119;1:3u", [["release", "w"]]),
        (b"\x1b[119;;119u\x1b[O", [["blur"]]),
        (b"\x1b[I\x1b[119;;119u\x1b[119;1:3u", [["press", "w", "p_up"], ["release", "w", "r_up"]]),
    ]
    for sent, reports in conversation:
        driving.send(sent)
        driving.until_reported(*reports)


def test_answers_are_never_typed(terminal: Run) -> None:
    app = terminal("drive_app.py", attributes=LONG_ATTRIBUTES)
    app.until_reported(["mode", "exact"])
    app.send(b"\x1b[?62;52;c" + b"\x1b[?27u" + LONG_ATTRIBUTES + b"\x1b[?31uw")
    app.until_reported(["press", "w", "p_up"])
    assert not [report for report in app.reports if report[0] == "press"]


@pytest.mark.parametrize("traits", [{"kitty": False}, {"kitty": False, "attributes": LONG_ATTRIBUTES}])
def test_a_terminal_without_the_protocol_gets_learned_repeats(
    terminal: Run, traits: dict[str, object]
) -> None:
    app = terminal("drive_app.py", **traits)
    app.until_reported(["mode", "hold"])
    app.send(b"\x1b[A")
    app.until_reported(["press", "up", "p_up"], ["strength", {"up": 0.35}], ["timeout", "", "r_up"])
    app.send(b"\x1bOC")
    app.until_reported(["press", "right", "p_right"], ["timeout", "", "r_right"])


def test_releases_are_asked_for_only_while_a_screen_drives(driving: Any) -> None:
    assert driving.modes.keyboard == 27
    driving.send(b"\x1b[119;;119u\x1b[52;;52u")
    driving.until_reported(["press", "w", "p_up"])
    driving.until(lambda: driving.modes.keyboard == 25, "the flag cleared")
    driving.send(b"\x1b[119;;119u")
    driving.until_reported(["elsewhere", "w"])
    driving.send(b"\x1b[53;;53u")
    driving.until_reported(["answer", 27])
    assert driving.modes.keyboard == 27
    driving.send(b"\x1b[119;;119u")
    driving.until_reported(["press", "w", "p_up"])  # going away had released it


def test_one_driving_screen_on_another(driving: Any) -> None:
    driving.send(b"\x1b[119;;119u\x1b[48;;48u")
    driving.until_reported(["press", "w", "p_up"], ["answer", 27])
    driving.send(b"\x1b[119;;119u\x1b[119;1:3u")
    driving.until_reported(["press", "w", "p_up"], ["release", "w", "r_up"])
    driving.send(b"\x1b[53;;53u")
    driving.until_reported(["answer", 27])
    driving.send(b"\x1b[119;;119u")
    driving.until_reported(["press", "w", "p_up"])
    assert driving.modes.keyboard == 27


def test_a_suspension_gives_the_terminal_back_and_takes_it_again(driving: Any) -> None:
    driving.send(b"\x1b[119;;119u\x1b[56;;56u")
    driving.until_reported(["press", "w", "p_up"], ["suspended"], ["answer", 27])
    given_back = driving.output.index(b"\x1b[?1049l")
    assert b"\x1b[<u" in driving.output[:given_back]
    driving.send(b"\x1b[119;;119u")
    driving.until_reported(["press", "w", "p_up"])
    driving.send(b"\x1b[51;;51u")
    driving.wait()
    driving.assert_sane()


def test_stopped_by_the_shell_and_continued(driving: Any) -> None:
    os.kill(driving.process.pid, signal.SIGTSTP)
    driving.until(lambda: driving.modes.on == {7, 25}, "the terminal given back")
    driving.until(
        lambda: os.waitid(os.P_PID, driving.process.pid, os.WSTOPPED | os.WNOHANG | os.WNOWAIT), "the stop"
    )
    driving.assert_sane()
    os.kill(driving.process.pid, signal.SIGCONT)
    driving.until_reported(["answer", 27])
    driving.send(b"\x1b[119;;119u")
    driving.until_reported(["press", "w", "p_up"])


def sends(text: bytes) -> Callable[[Any], None]:
    return lambda app: app.send(text)


def kills(number: int, times: int = 1) -> Callable[[Any], None]:
    def kill(app: Any) -> None:
        for _ in range(times):
            os.kill(app.process.pid, number)

    return kill


WAYS_OUT: dict[str, tuple[Callable[[Any], None], set[int]]] = {
    "exit": (sends(b"\x1b[51;;51u"), {0}),
    "Textual's own quit key": (sends(b"\x1b[113;5u"), {0}),
    "an exception": (sends(b"\x1b[49;;49u"), {0, 1}),
    "SystemExit": (sends(b"\x1b[50;;50u"), {3}),
    "SIGTERM": (kills(signal.SIGTERM), {-signal.SIGTERM}),
    "SIGHUP": (kills(signal.SIGHUP), {-signal.SIGHUP}),
    "SIGQUIT": (kills(signal.SIGQUIT), {-signal.SIGQUIT}),
    "SIGINT": (kills(signal.SIGINT), {0, -signal.SIGINT, 1, 130}),
    "SIGINT twice": (kills(signal.SIGINT, times=2), {0, -signal.SIGINT, 1, 130}),
    "SIGTERM twice": (kills(signal.SIGTERM, times=2), {-signal.SIGTERM}),
}


@pytest.mark.parametrize("drawing", [False, True], ids=["idle", "drawing"])
@pytest.mark.parametrize("way", WAYS_OUT)
def test_every_way_out_leaves_a_sane_terminal(driving: Any, way: str, drawing: bool) -> None:
    leave, statuses = WAYS_OUT[way]
    if drawing:
        driving.send(b"7")
        driving.until(lambda: driving.output.count(b"\x1b[1;1H") > 5, "frames")
    leave(driving)
    assert driving.wait() in statuses
    driving.assert_sane()
    *_, after = driving.output.rpartition(b"\x1b[?1049l")
    drawn = re.sub(rb"\x1b\[\?\d+[hl]", b"", after)
    assert b"\x1b[1;1H" not in drawn  # no frame on the user's own screen


def test_the_release_of_the_key_that_quit_does_not_end_up_in_the_shell(terminal: Run) -> None:
    app = terminal("drive_app.py", on_the_way=b"\x1b[51;1:3u")
    app.until_reported(["mode", "exact"])
    app.send(b"\x1b[51;;51u")
    assert app.wait() == 0
    app.assert_sane()
    assert b"51;1:3" not in app.output


def test_the_terminal_goes_away(driving: Any) -> None:
    """A dropped connection: the process ends, by the signal or because there is nobody to read from."""
    driving.hang_up()
    driving.process.wait(20)
    assert driving.process.returncode in {-signal.SIGHUP, 0, 129}


# What we use of Textual beyond its public names. When one of these fails after an update of Textual, look here.


def test_the_app_keeps_its_driver_in_a_private_name() -> None:
    assert "self._driver" in inspect.getsource(App._build_driver)
    assert key_driver(App()) is None


@every_case(
    "name",
    ["_file", "fileno", "exit_event", "_key_thread", "_writer_thread"],
    ids=lambda name: name.strip("_"),
)
def test_the_linux_driver_has_the_attributes_we_use(name: str) -> None:
    assert f"self.{name}" in inspect.getsource(LinuxDriver.__init__)


@pytest.mark.parametrize("name", ["_app", "_debug"])
def test_every_driver_has_the_attributes_we_use(name: str) -> None:
    assert f"self.{name} = " in inspect.getsource(Driver.__init__)


def test_the_linux_driver_starts_the_input_thread_through_the_method_we_replace() -> None:
    assert "self.run_input_thread()" in inspect.getsource(LinuxDriver._run_input_thread)
    assert "target=self._run_input_thread" in inspect.getsource(LinuxDriver.start_application_mode)


def test_closing_the_driver_waits_until_all_is_written() -> None:
    assert "self._writer_thread.stop()" in inspect.getsource(LinuxDriver.close)
    assert "self.join()" in inspect.getsource(WriterThread.stop)


def test_textual_pushes_the_flags_to_which_we_add_one() -> None:
    assert linux_driver.KITTY_REPORT_EVENT_TYPES == 2
    assert f"\x1b[={linux_driver.KITTY_REPORT_EVENT_TYPES};2u" == RELEASES_ON
    assert f"\x1b[={linux_driver.KITTY_REPORT_EVENT_TYPES};3u" == RELEASES_OFF
    source = inspect.getsource(LinuxDriver.start_application_mode)
    assert "KITTY_REPORT_ALL_KEYS" in source
    assert "KITTY_REPORT_EVENT_TYPES" not in source


def test_textual_pops_the_flags_before_it_leaves_the_alternate_screen() -> None:
    source = inspect.getsource(LinuxDriver.stop_application_mode)
    assert source.index("[<u") < source.index("[?1049l")


@pytest.mark.parametrize("number", FATAL)
@pytest.mark.parametrize("way", ["wait", "threads"])
def test_a_fatal_signal(terminal: Run, number: signal.Signals, way: str) -> None:
    app = terminal("guarded.py", way)
    app.until_reported("taken")
    os.kill(app.process.pid, number)
    assert app.wait() == -number
    app.assert_sane()
    assert b"frame" not in app.output.rpartition(b"\x1b[?1049l")[2]


@pytest.mark.parametrize(("way", "status"), [("error", 1), ("exit", 5), ("ignored", 6)])
def test_an_end_without_a_signal(terminal: Run, way: str, status: int) -> None:
    app = terminal("guarded.py", way)
    assert app.wait() == status
    app.assert_sane()


def test_the_terminal_is_restored_before_another_handler_runs(terminal: Run) -> None:
    app = terminal("guarded.py", "handled")
    app.until_reported("taken")
    os.kill(app.process.pid, signal.SIGTERM)
    assert app.wait() == 7
    app.assert_sane()


def test_disarmed_it_does_nothing(terminal: Run) -> None:
    app = terminal("guarded.py", "disarmed")
    assert app.wait() == 0
    assert app.modes.alternate
    assert termios.tcgetattr(app.other_fd) != app.attributes_before


def test_a_closed_output_is_no_error(terminal: Run) -> None:
    app = terminal("guarded.py", "closed")
    assert app.wait() == 8
    assert termios.tcgetattr(app.other_fd) == app.attributes_before


def test_a_terminal_that_takes_nothing_does_not_hold_us() -> None:
    ours, theirs = os.openpty()
    before = termios.tcgetattr(theirs)
    os.set_blocking(theirs, False)
    with suppress(BlockingIOError):
        while True:
            os.write(theirs, b"x" * 4096)
    os.set_blocking(theirs, True)
    restore_terminal(theirs, theirs, before)
    os.close(ours)
    restore_terminal(theirs, theirs, before)
    os.close(theirs)
    restore_terminal(theirs, theirs, before)


def test_what_is_no_terminal_is_left_alone() -> None:
    reader, writer = os.pipe()
    restore_terminal(reader, writer, None)
    assert os.read(reader, 1000).endswith(b"\x1b[?25h")
    os.close(reader)
    restore_terminal(writer, writer, None)
    os.close(writer)
