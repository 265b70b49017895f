"""What is said to a terminal about its keyboard: the kitty keyboard protocol, as far as the kit needs it.

https://sw.kovidgoyal.net/kitty/keyboard-protocol/#progressive-enhancement
"""

from __future__ import annotations

from typing import Final

ASK_FLAGS: Final = "\x1b[?u"
"""Answered ``CSI ? flags u`` by a terminal that knows the protocol, by others not at all."""
ASK_ATTRIBUTES: Final = "\x1b[c"
"""Answered ``CSI ? ... c`` by every terminal, after all that was asked before: whoever has been silent is silent."""

PUSH_ALL: Final = "\x1b[>27u"
"""Flags 1 disambiguate, 2 event types, 8 all keys as sequences, 16 their text. Textual pushes all but 2."""
POP: Final = "\x1b[<u"
"""Undoes one push. To be said before leaving the alternate screen: each screen has its own stack."""

RELEASES_ON: Final = "\x1b[=2;2u"
"""Sets flag 2 in what was pushed last."""
RELEASES_OFF: Final = "\x1b[=2;3u"
"""Clears flag 2."""

_NEEDED: Final = 2 | 8


def reports_releases(flags: int | None) -> bool:
    """Whether a terminal with these flags says when a letter key goes up: flag 2, and 8 or it is for other keys."""
    return flags is not None and flags & _NEEDED == _NEEDED
