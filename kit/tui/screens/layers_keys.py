"""The keys of the layers screen in words, and how to read its picture and its table."""

from __future__ import annotations

from typing import Final

from kit.tui.rows.key_rows import key_line, key_page

WALK_KEYS: Final = key_line(
    ("arrows", "step, scroll"),
    ("1-4", "part"),
    ("c", "choose"),
    ("e", "edit"),
    ("x", "examples"),
    ("s", "save"),
    ("?", "help"),
    ("Esc", "leave"),
)

EDIT_KEYS: Final = key_line(
    ("arrows", "move"),
    ("Space", "mark"),
    ("m", "map"),
    ("b", "body"),
    ("l", "laser"),
    ("d", "del"),
    ("u", "undo"),
    ("f", "free"),
    ("?", "help"),
    ("Esc", "done"),
)

WALK_HELP: Final = key_page(
    (
        ("left  right", "one step back, one step on"),
        ("up  down", "scroll the words, where they are too many"),
        ("1  2  3  4", "case, slides' method, fewest layers, why no fewer"),
        ("c", "choose the edge this step of the method begins with"),
        ("e", "change the case by hand"),
        ("x", "another case: examples, and the kit's own maps"),
        ("s", "save what is asked as a file for kit layers plan"),
    ),
    (
        ("[ name ]", "in the layer of this step; its edges are thick"),
        ("a dotted edge", "struck: some layer holds both its ends already"),
        ("# name #", "a map"),
        ("< name >", "a laser, with beams to all it must see"),
    ),
)

EDIT_HELP: Final = key_page(
    (
        ("#", "must collide; in a laser's row, must be seen"),
        ("~", "may share a layer, or be seen: nobody minds"),
        (".", "must not"),
        ("Space", "turns the mark under the cursor to the next of these"),
    ),
    (
        ("m  b  l", "a new map, body or laser; then type its name"),
        ("", "MODEL.PART is a part of a model"),
        ("d  u", "delete the row; undo the last change"),
        ("f", "assume that bodies of one model never meet, as the"),
        ("", "slides do and Flatland does not"),
    ),
)
