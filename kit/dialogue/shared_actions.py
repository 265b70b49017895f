"""The actions that several screens have: their keys and their words."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from kit.dialogue.screen_action import ScreenAction, letter

_CHOOSE: Final = (
    ("up", "choose(0, -1)"),
    ("down", "choose(0, 1)"),
    ("left", "choose(-1, 0)"),
    ("right", "choose(1, 0)"),
    ("pageup", "choose(0, -10)"),
    ("pagedown", "choose(0, 10)"),
    ("home", "choose(0, -1000)"),
    ("end", "choose(0, 1000)"),
)
_MOVE: Final = (
    *((key, call.replace("choose", "move")) for key, call in _CHOOSE[:6]),
    ("home", "move(-1000, 0)"),
    ("end", "move(1000, 0)"),
)
_SCROLL: Final = (
    ("up", "scroll(-1)"),
    ("down", "scroll(1)"),
    ("pageup", "scroll(-10)"),
    ("pagedown,space", "scroll(10)"),
    ("home", "scroll(-1000000)"),
    ("end", "scroll(1000000)"),
)


_SHARED: Final = (
    ScreenAction("next", "n Enter", "next", "go to the next step, question, page or episode", (("n,enter", "next"),), "n"),
    ScreenAction("open", "Enter", "open", "open the selected item", (("enter", "open"),)),
    ScreenAction("close", "Enter", "close", "the same as Esc", (("enter", "back"),)),
    letter("previous", "b", "previous", "go to the previous step or page; change an answer"),
    ScreenAction(
        "back", "Esc q Backspace", "back", "go back", (("escape,q,backspace", "back"),)
    ),
    ScreenAction("quit", "Ctrl-C", "quit", "quit the kit", (("ctrl+c,ctrl+q", "app.quit"),), "^C", has_priority=True),
    letter("help", "?", "help", "show the keys that work here", name="question_mark"),
    ScreenAction("palette", "Ctrl-P", "find", "list all commands; type to find one", (("ctrl+p", "app.palette"),), "^P"),
    ScreenAction("glossary", ",", "glossary", "open the glossary, which explains the terms", (("comma", "app.glossary"),)),
    letter("restart", "r", "restart", "start the scene, drive, puzzle or world again"),
    letter("check", "c", "check", "check your work; saving its file checks it too"),
    letter("hint", "h", "hint", "show the next hint for a criterion you missed"),
    letter("solution", "s", "solution", "show the reference solution, once yours passes"),
    letter("replay", "w", "replay", "replay the run of the last check, or a drive"),
    letter("pause", "p", "pause", "pause or continue"),
    letter("step", ".", "step", "make one step while paused", name="full_stop"),
    ScreenAction("choose", "arrows", "choose", "move; PgUp, PgDn, Home and End move further", _CHOOSE),
    ScreenAction("scroll", "↑↓ PgUp PgDn", "scroll", "scroll the text", _SCROLL, "↑↓"),
    ScreenAction("zoom", "+ -", "zoom", "zoom in and out", (("plus,equals_sign", "zoom(1)"), ("minus", "zoom(-1)")), "+ -"),
    letter("fit", "0", "fit", "fit the whole world into the picture"),
    letter("follow", "v", "follow", "make the picture follow the robot"),
    letter("hand_over", "g", "program", "let a program drive: the last one, or another"),
    letter("drive_mode", "z", "key mode", "choose how keys drive: automatic, latch, hold"),
    letter("choose_map", "m", "map", "choose another map or case"),
)  # fmt: skip

_OF_SEVERAL: Final = (
    # of the lesson, whose line mode has them too
    letter("edit_file", "e", "edit", "edit your file in $EDITOR or nano, else as with ^E"),
    ScreenAction("editor", "Ctrl-E", "editor", "open or close the kit's own editor", (("ctrl+e", "editor"),), "^E"),
    ScreenAction("save_program", "Ctrl-S", "save", "save what is in the editor; it is used at once",
                 (("ctrl+s", "save_program"),), "^S"),
    letter("second_terminal", "a", "second terminal", "explain how to open a second terminal"),
    letter("defend", "y", "defend", "answer questions about your own program"),
    letter("output", "u", "output", "show what your program printed"),
    letter("drive", "d", "drive", "drive, if the exercise is a drive"),
    letter("start_over", "x", "start over", "start over with the starter files; asks first"),
    letter("steps", "l", "steps", "list all steps"),
    # of several screens
    letter("begin", "t", "train", "set up a new training, or start it"),
    letter("agent_view", "i", "agent", "show what the agent perceives and its action values"),
    ScreenAction("move_cursor", "arrows", "move", "move the cursor; PgUp, PgDn, Home and End: further", _MOVE),
    letter("undo", "u", "undo", "undo the last change"),
    letter("share", "y", "share", "save the card of a drive, or the robot's map"),
    letter("filter", "/", "filter", "show only names that contain a text; Esc shows all", name="slash", has_priority=True),
    # where keys drive a robot
    ScreenAction("drive_keys", "arrows W A S D", "drive", "drive; you take over from the program", (), "←↑↓→"),
    ScreenAction("stop_robot", "Space", "stop", "stop the robot", ()),
    ScreenAction("node_keys", "Q E F Space Esc", "keys", "send keys to your nodes on /teleopkeys; Space stops", ()),
    ScreenAction("speed", "1 2 3", "speed", "run in real time, 10x faster, or at full speed",
           tuple((key, f"speed('{key}')") for key in "123"), "123"),
    ScreenAction("pan", "h j k l", "pan", "move the picture left, down, up, right", tuple((key, f"pan('{key}')") for key in "hjkl")),
    letter("beams", "b", "beams", "show the laser's beams"),
    letter("laser_map", "u", "robot's map", "show the map that the robot draws with its laser"),
    letter("controllers", "c", "code", "choose another program; it reloads when saved"),
    letter("nodes", "n", "nodes", "show nodes, topics and their messages"),
    letter("trainings", "t", "trainings", "show trainings, with curves and newest policies"),
    letter("ghosts", "o", "ghosts", "show or hide the ghosts"),
)  # fmt: skip

ACTIONS: Final[Mapping[str, ScreenAction]] = MappingProxyType(
    {action.id: action for action in (*_SHARED, *_OF_SEVERAL)}
)
SHARED_IDS: Final = frozenset(action.id for action in _SHARED)
VIEW_IDS: Final = ("fit", "pan", "follow", "beams")
"""Actions of every picture of a running world."""
