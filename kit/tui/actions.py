"""The actions of all screens: their keys, their words, and which screen has which.

Each screen's bindings, the line of keys at its bottom and its help page are made from these two tables; the line mode
takes its letters and words from them too. ``.github/CONTRIBUTING.md`` prints them, and a test compares the two.

Outside the screens where keys drive a robot, a letter of an action that several screens have means nothing else anywhere.
No Textual here: the line mode imports this module.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Final


@dataclass(frozen=True, slots=True)
class ScreenAction:
    """One thing that a key does."""

    id: str
    keys: str
    """Keys as the help page and the table print them."""
    label: str
    """Its word in the line at the bottom, and in the line mode."""
    help: str
    """What it does, in at most 52 characters, so that the help page fits into 74 columns."""
    bindings: tuple[tuple[str, str], ...] = ()
    """Textual's names of keys, comma-separated, and the Textual action they call. Empty: a widget reads the keys itself."""
    short: str = ""
    """The keys in the line at the bottom, where that is not the first of ``keys``."""
    has_priority: bool = False
    """Whether it comes before the focused widget."""

    @property
    def footer_keys(self) -> str:
        return self.short or self.keys.split()[0]


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
_DRAW_ALONG: Final = (
    ("shift+up", "draw(0, -1)"),
    ("shift+down", "draw(0, 1)"),
    ("shift+left", "draw(-1, 0)"),
    ("shift+right", "draw(1, 0)"),
)
_SCROLL: Final = (
    ("up", "scroll(-1)"),
    ("down", "scroll(1)"),
    ("pageup", "scroll(-10)"),
    ("pagedown,space", "scroll(10)"),
    ("home", "scroll(-1000000)"),
    ("end", "scroll(1000000)"),
)


def _digits(action: str, first: int, last: int) -> tuple[tuple[str, str], ...]:
    return tuple((str(number), f"{action}({number})") for number in range(first, last + 1))


def _letter(
    id_: str, key: str, label: str, text: str, *, name: str = "", short: str = "", has_priority: bool = False
) -> ScreenAction:
    """An action of one key that calls the Textual action of its own name. ``name``: Textual's name of the key."""
    return ScreenAction(id_, key, label, text, ((name or key, id_),), short, has_priority)


_SHARED: Final = (
    ScreenAction("next", "n Enter", "next", "go to the next step, question, page or episode", (("n,enter", "next"),), "n"),
    ScreenAction("open", "Enter", "open", "open the selected item", (("enter", "open"),)),
    ScreenAction("close", "Enter", "close", "the same as Esc", (("enter", "back"),)),
    _letter("previous", "b", "previous", "go to the previous step or page; change an answer"),
    ScreenAction(
        "back", "Esc q Backspace", "back", "go back", (("escape,q,backspace", "back"),)
    ),
    ScreenAction("quit", "Ctrl-C", "quit", "quit the kit", (("ctrl+c,ctrl+q", "app.quit"),), "^C", has_priority=True),
    _letter("help", "?", "help", "show this page", name="question_mark"),
    ScreenAction("palette", "Ctrl-P", "commands", "list all commands; type to find one", (("ctrl+p", "app.palette"),)),
    ScreenAction("glossary", ",", "glossary", "open the glossary, which explains the terms", (("comma", "app.glossary"),)),
    _letter("restart", "r", "restart", "start the scene, the drive or the world again"),
    _letter("check", "c", "check", "check the exercise; saving the file checks it too"),
    _letter("hint", "h", "hint", "show a hint for the first criterion you missed"),
    _letter("solution", "s", "solution", "show the reference solution, once yours passes"),
    _letter("replay", "w", "replay", "replay the run of the last check, or a drive"),
    _letter("pause", "p", "pause", "pause or continue"),
    _letter("step", ".", "step", "make one step while paused", name="full_stop"),
    ScreenAction("choose", "arrows", "choose", "move; PgUp, PgDn, Home and End move further", _CHOOSE),
    ScreenAction("scroll", "↑↓ PgUp PgDn", "scroll", "scroll the text", _SCROLL, "↑↓"),
    ScreenAction("zoom", "+ -", "zoom", "zoom in and out", (("plus,equals_sign", "zoom(1)"), ("minus", "zoom(-1)")), "+ -"),
    _letter("fit", "0", "fit", "fit the whole world into the picture"),
    _letter("follow", "v", "follow", "make the picture follow the robot"),
    _letter("hand_over", "g", "program", "let a program drive: the last one, or another"),
    _letter("drive_mode", "z", "key mode", "choose how keys drive: automatic, latch, repeat"),
    _letter("choose_map", "m", "map", "choose another map or case"),
)  # fmt: skip

_OWN: Final = (
    # the lesson
    ScreenAction("predict", "1 2 3 4", "predict", "predict; your first choice counts", _digits("predict", 1, 4), "1-4"),
    ScreenAction("drive_scene", "arrows", "drive", "drive the robot, in a scene that waits for you", (), "←↑↓→"),
    _letter("edit_file", "e", "edit", "edit your file in $EDITOR or nano; saving checks it"),
    _letter("run_command", "o", "run", "run a command of this step here"),
    _letter("second_terminal", "a", "second terminal", "explain how to open a second terminal"),
    _letter("defend", "y", "defend", "answer questions about your own program"),
    ScreenAction("defence_answer", "1 2 3", "answer", "choose an answer; it counts", _digits("answer", 1, 3), "1-3"),
    _letter("output", "u", "output", "show what your program printed"),
    _letter("drive", "d", "drive", "drive, if the exercise is a drive"),
    _letter("start_over", "x", "start over", "start over with the starter files; asks first"),
    _letter("steps", "l", "steps", "list all steps"),
    _letter("questions", "k", "questions", "answer the lesson's questions, after its last step"),
    # the quiz
    ScreenAction("answer", "1 2 3", "answer", "choose an answer, then say how sure you are", _digits("answer", 1, 4), "1-3"),
    ScreenAction("confidence", "1 2 3 4", "how sure", "say how sure you are of your answer", (), "1-4"),
    ScreenAction("not_sure", "0", "not sure", "say that you do not know; not counted as wrong", (("0", "answer(0)"),)),
    _letter("skip", "x", "leave blank", "leave the question blank; press it twice"),
    # the form
    ScreenAction("form_answer", "1 to 7", "answer", "choose an answer; Enter keeps it", _digits("answer", 1, 7), "1-7"),
    _letter("type_answer", "e", "type", "type your answer; Esc ends typing, Enter keeps it"),
    _letter("clear_answer", "x", "clear", "clear the answer, so that Enter leaves it blank"),
    # training
    _letter("stop", "x", "stop", "stop the training; what it has learned is kept"),
    _letter("figures", "Tab", "figures", "show the other figures: cases, reward by term", name="tab"),
    _letter("curve", "y", "curve", "change the curve: success, reward, reward terms"),
    _letter("agent_view", "i", "agent", "show what the agent perceives and its action values"),
    # the list of trainings, and a new training
    _letter("begin", "t", "train", "set up a new training, or start it"),
    _letter("evaluate", "e", "evaluate", "test the selected run on new episodes"),
    ScreenAction("mark_run", "Space", "mark", "mark a run, to compare the marked ones", (("space", "mark"),)),
    _letter("compare", "o", "compare", "compare the marked runs on the same episodes"),
    _letter("sweeps", "f", "sweeps", "show the tables of kit sweep: many seeds compared"),
    _letter("robustness", "k", "robustness", "show the selected run's success under disturbances"),
    _letter("rename", "a", "rename", "rename the selected run"),
    ScreenAction("delete_run", "d Del", "delete", "delete the selected run; asks first", (("d,delete", "delete"),)),
    ScreenAction("change", "Enter", "change", "change the selected setting", (("enter", "open"),)),
    # drawing a map
    ScreenAction("move_cursor", "arrows", "move", "move the cursor; PgUp, PgDn, Home and End: further", _MOVE),
    ScreenAction("draw_along", "Shift+arrows", "draw", "draw with the pen while moving", _DRAW_ALONG, "Shift"),
    ScreenAction("put", "Space", "put", "draw with the pen under the cursor", (("space", "draw(0, 0)"),)),
    ScreenAction("pen", "1 2 3 4", "pen", "choose the pen: wall, floor, start, target", _digits("pen", 1, 4), "1-4"),
    ScreenAction("square_size", "[ ]", "scale", "make the squares smaller or larger (map scale)",
           (("left_square_bracket", "scale(-1)"), ("right_square_bracket", "scale(1)")), "[ ]"),
    ScreenAction("undo_drawing", "u", "undo", "undo the last change of the drawing", (("u", "undo"),)),
    ScreenAction("save_map", "f", "save", "save the map, if the target can be reached", (("f", "save"),), "f"),
    # the corners of a photograph
    ScreenAction("put_corner", "Space", "corner", "put a corner of the sheet under the cross", (("space", "put"),)),
    # nodes and topics
    _letter("filter", "/", "filter", "show only names that contain a text; Esc shows all", name="slash", has_priority=True),
    _letter("all_names", "a", "all", "show also ROS's own topics and unused services"),
    _letter("tidy", "t", "tidy", "arrange everything again"),
    _letter("plot", "y", "plot", "plot the selected field of a message over time"),
    # layers
    ScreenAction("page", "left right", "page", "go to the previous or next page", (("left", "page(-1)"), ("right", "page(1)")), "arrows"),
    ScreenAction("part", "1 2 3 4", "part", "show the case, slides' method, fewest layers, proof", _digits("part", 1, 4), "1-4"),
    _letter("other_edge", "o", "edge", "change the edge that this step starts with"),
    _letter("edit", "e", "edit", "change the case by hand"),
    _letter("save", "f", "save", "save the requirements as a file for kit layers plan", has_priority=True),
    ScreenAction("mark", "Space Enter", "mark", "change the mark under the cursor", (("space,enter", "mark"),)),
    ScreenAction("add_map", "1", "map", "add a map, then type its name", (("1", "add('map')"),), has_priority=True),
    ScreenAction("add_body", "2", "body", "add a body, or a part of a model as MODEL.PART", (("2", "add('body')"),), has_priority=True),
    ScreenAction("add_laser", "3", "laser", "add a laser, then type its name", (("3", "add('laser')"),), has_priority=True),
    ScreenAction("delete", "d Del", "delete", "delete the row under the cursor", (("d,delete", "delete"),)),
    _letter("undo", "u", "undo", "undo the last change"),
    _letter("one_model", "f", "one model", "assume that bodies of one model never collide"),
    # the game
    _letter("agent", "a", "agent", "let an agent that you trained drive the level"),
    _letter("hall_of_fame", "f", "fame", "show this machine's leaderboard"),
    _letter("join", "j", "join", "add or remove your name and times"),
    _letter("daily", "d", "daily", "drive the level of the day, the same for everyone"),
    _letter("share", "y", "share", "save the card of a drive, or the robot's map"),
    # the start screen and lists
    ScreenAction("choose_line", "↑↓ Tab", "choose", "move to the next or previous line of the menu",
           (("down,tab", "choose(0, 1)"), ("up,shift+tab", "choose(0, -1)"))),
    ScreenAction("line", "1 to 9", "open", "open that line of the menu",
           tuple((str(number), f"open({number - 1})") for number in range(1, 10)), "1-9"),
    ScreenAction("drive_letters", "W A S D", "drive", "drive the robot in the picture", (), "WASD"),
    ScreenAction("type", "letters", "filter", "show only lines that contain what you type", ()),
    # where keys drive a robot
    ScreenAction("interrupt", "Ctrl-C", "back", "save the drive and go back to the lesson", (("ctrl+c,ctrl+q", "interrupt"),),
           "^C", has_priority=True),
    ScreenAction("drive_keys", "arrows W A S D", "drive", "drive; you take over from the program", (), "←↑↓→"),
    ScreenAction("stop_robot", "Space", "stop", "stop the robot", ()),
    ScreenAction("program_keys", "arrows W A S D", "keys", "send keys to programs that listen to /teleopkeys", (), "←↑↓→"),
    ScreenAction("node_keys", "Q E F Space Esc", "keys", "send keys to your nodes on /teleopkeys; Space stops", ()),
    ScreenAction("speed", "1 2 3", "speed", "run in real time, 10x faster, or at full speed",
           tuple((key, f"speed('{key}')") for key in "123"), "123"),
    ScreenAction("pan", "h j k l", "pan", "move the picture left, down, up, right", tuple((key, f"pan('{key}')") for key in "hjkl")),
    _letter("beams", "b", "beams", "show the laser's beams"),
    _letter("laser_map", "x", "robot's map", "show the map that the robot draws with its laser"),
    _letter("controllers", "c", "code", "choose another program; it reloads when saved"),
    ScreenAction("editor", "Ctrl-E", "editor", "open or close the program's editor",
           (("ctrl+e", "editor"),), "^E"),
    ScreenAction("save_program", "Ctrl-S", "save", "save the program; the robot uses it at once",
           (("ctrl+s", "save_program"),), "^S"),
    _letter("nodes", "n", "nodes", "show nodes, topics and their messages"),
    _letter("trainings", "t", "trainings", "show trainings, with curves and newest policies"),
    _letter("ghosts", "o", "ghosts", "show or hide the ghosts"),
    _letter("intensity", "i", "intensity", "select an intensity: walls, target, robot, tension"),
    ScreenAction("scale", "[ ]", "change", "decrease or increase it; the program adapts at once",
           (("left_square_bracket", "scale(-1)"), ("right_square_bracket", "scale(1)")), "[ ]"),
    _letter("arrows_shown", "o", "arrows", "change the arrows: forces, planned directions, none"),
    _letter("close_key_test", "x", "close", "close the key test"),
)  # fmt: skip

ACTIONS: Final[Mapping[str, ScreenAction]] = MappingProxyType(
    {action.id: action for action in (*_SHARED, *_OWN)}
)
SHARED_IDS: Final = frozenset(action.id for action in _SHARED)


@dataclass(frozen=True, slots=True)
class ScreenActions:
    """The actions of one screen, by id."""

    name: str
    """Name of the screen in the table in CONTRIBUTING.md."""
    footer: tuple[str, ...]
    """Actions in the bottom line, the most important first: a narrow line leaves out the last ones."""
    more: tuple[str, ...] = ()
    """On the help page alone."""
    drives: bool = False
    """Whether letters drive a robot here, so that letters may mean something else than on other screens."""

    @property
    def ids(self) -> tuple[str, ...]:
        return (*self.footer, *self.more)


_VIEW: Final = ("fit", "pan", "follow", "beams")


def _with_glossary(screen: ScreenActions) -> ScreenActions:
    """Every screen that has a help page opens the glossary and the list of commands too."""
    return replace(screen, more=(*screen.more, "glossary", "palette")) if "help" in screen.ids else screen


SCREENS: Final[Mapping[str, ScreenActions]] = MappingProxyType(
    {
        screen.name: _with_glossary(screen)
        for screen in (
            ScreenActions(
                "start",
                ("open", "line", "choose_line", "drive_letters", "help", "quit"),
                ("hand_over", "restart", "drive_mode"),
            ),
            ScreenActions("lessons", ("choose", "open", "help", "back")),
            ScreenActions(
                "lesson",
                (
                    "predict", "drive_scene", "check", "edit_file", "hint", "drive", "replay", "solution", "next", "defend",
                    "run_command",
                    "second_terminal",
                    "output", "questions", "previous", "restart", "pause", "step", "start_over", "help", "back",
                ),
                ("steps", "scroll", "quit"),
            ),
            ScreenActions("defence", ("defence_answer", "restart", "back")),
            ScreenActions(
                "quiz",
                ("answer", "confidence", "not_sure", "skip", "next", "previous", "help", "back"),
                ("scroll",),
            ),
            ScreenActions(
                "form",
                ("form_answer", "type_answer", "next", "choose", "previous", "clear_answer", "help", "back"),
            ),
            ScreenActions("levels", ("choose", "open", "hand_over", "agent", "replay", "hall_of_fame", "daily", "help", "back")),
            ScreenActions("challenge", ("check", "edit_file", "next", "help", "back"), ("scroll",)),
            ScreenActions("leaderboard", ("scroll", "join", "back"), ("close",)),
            ScreenActions("level result", ("next", "restart", "replay", "share", "back")),
            ScreenActions(
                "training",
                ("pause", "stop", "agent_view", "figures", "curve", "choose_map", "help", "back"),
                ("zoom", "next", "fit", "follow", "quit"),
            ),
            ScreenActions(
                "trainings",
                ("choose", "open", "begin", "evaluate", "mark_run", "compare", "sweeps", "robustness", "rename", "delete_run", "help", "back"),
            ),
            ScreenActions("new training", ("choose", "change", "begin", "help", "back")),
            ScreenActions(
                "map drawing",
                ("move_cursor", "pen", "put", "save_map", "draw_along", "square_size", "undo_drawing", "help", "back"),
            ),
            ScreenActions(
                "photo corners",
                ("put_corner", "next", "move_cursor", "zoom", "fit", "undo", "help", "back"),
            ),
            ScreenActions(
                "nodes", ("choose", "open", "plot", "filter", "all_names", "tidy", "pause", "step", "help", "back")
            ),
            ScreenActions(
                "layers",
                ("page", "part", "other_edge", "edit", "choose_map", "save", "help", "back"),
                ("next", "previous", "scroll"),
            ),
            ScreenActions(
                "case editor",
                ("choose", "mark", "add_map", "add_body", "add_laser", "delete", "undo", "one_model", "help", "back"),
            ),
            ScreenActions("text", ("scroll", "back"), ("close",)),
            ScreenActions("list", ("choose", "back"), ("type",)),
            ScreenActions(
                "drive",
                (
                    "drive_keys", "pause", "speed", "choose_map", "controllers", "nodes", "restart", "help",
                    "back", "quit",
                ),
                ("editor", "save_program", "step", "trainings", "agent_view", "laser_map", "share", "hand_over", "drive_mode", "node_keys", "zoom", *_VIEW),
                drives=True,
            ),
            ScreenActions(
                "fields",
                (
                    "intensity", "scale", "arrows_shown", "controllers", "choose_map", "pause", "restart", "help",
                    "back", "quit",
                ),
                ("drive_keys", "step", "speed", "nodes", "trainings", "hand_over", "drive_mode", "zoom", *_VIEW),
                drives=True,
            ),
            ScreenActions(
                "level",
                ("drive_keys", "stop_robot", "restart", "pause", "help", "back"),
                ("ghosts", "agent_view", "laser_map", "share", "speed", "drive_mode", "zoom", *_VIEW, "quit"),
                drives=True,
            ),
            ScreenActions(
                "shared game",
                ("drive_keys", "stop_robot", "help", "back", "quit"),
                ("ghosts", "drive_mode", "zoom", *_VIEW),
                drives=True,
            ),
            ScreenActions(
                "recorded drive",
                ("drive_keys", "stop_robot", "restart", "pause", "help", "back"),
                ("close", "step", "speed", "drive_mode", "zoom", *_VIEW, "interrupt"),
                drives=True,
            ),
            ScreenActions(
                "launch",
                ("program_keys", "pause", "step", "speed", "nodes", "restart", "zoom", "help", "back", "quit"),
                ("node_keys", "drive_mode", *_VIEW),
                drives=True,
            ),
            ScreenActions(
                "replay",
                ("pause", "step", "speed", "restart", "zoom", "help", "back", "quit"),
                ("agent_view", *_VIEW),
                drives=True,
            ),
            ScreenActions("key test", ("drive_mode", "close_key_test", "quit"), drives=True),
        )
    }
)  # fmt: skip
