"""The keys of the training screen in words, how to read it, and what is said on leaving it."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from kit.tui.rows.key_rows import key_line, key_page
from kit.tui.widgets.text_rows import Row

_ALWAYS: Final = (("Tab", "more"), ("y", "reward"), ("c", "case"), ("+ -", "zoom"), ("?", "help"))
_GO_ON: Final = (("p", "go on"),)
_BY_STATE: Final[Mapping[str, Row]] = MappingProxyType(
    {
        "running": key_line(("p", "pause"), ("s", "stop"), *_ALWAYS, ("Esc", "leave, it trains on")),
        "paused": key_line(*_GO_ON, ("s", "stop"), *_ALWAYS, ("Esc", "leave")),
        "stopped": key_line(*_GO_ON, *_ALWAYS, ("Esc", "leave")),
        "interrupted": key_line(*_GO_ON, *_ALWAYS, ("Esc", "leave")),
    }
)
_OVER: Final = key_line(*_ALWAYS, ("Esc", "leave"))


def keys(state: str) -> Row:
    """The line at the bottom, for a training in this state."""
    return _BY_STATE.get(state, _OVER)


TRAINING_HELP: Final = key_page(
    (
        ("the curve", "success, dashed: the goal; tests on fresh episodes"),
        ("the columns", "how the episodes of each batch in training ended"),
        ("the robot", "has the newest policy; once all is over, the best"),
        ("train, test", "% reached: of late in training; in the last test"),
    ),
    (
        ("p", "pause the training; go on, also after a stop or kill"),
        ("s", "stop it, with all it knows"),
        ("Tab", "the other figures: cases, reward by term"),
        ("y", "the curve: success or reward"),
        ("c", "let the robot drive one case, or all in turn"),
        ("n", "its next episode, now, with the newest policy"),
    ),
    (
        ("+  -  0", "nearer, farther, everything"),
        ("v", "follow the robot"),
        ("Esc", "leave: the training goes on, `kit watch` comes back"),
    ),
)

_FAREWELLS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "running": "{0} trains on. `kit watch {0}` shows it again, `kit runs {0} --stop` stops it.",
        "new": "{0} trains on. `kit watch {0}` shows it again, `kit runs {0} --stop` stops it.",
        "paused": "{0} stays paused. `kit watch {0}` shows it again, `kit runs {0} --go` goes on.",
        "stopped": "{0} is stopped. `kit train --resume {0}` goes on.",
        "interrupted": "{0} was interrupted. `kit train --resume {0}` goes on from its last checkpoint.",
        "finished": "{0} has finished. `kit evaluate {0}` tests the policy that was kept.",
        "failed": "{0} has failed. `kit runs {0}` says why.",
    }
)


def farewell(name: str, state: str) -> str:
    """How the run stands, and how to come back."""
    return _FAREWELLS[state].format(name)
