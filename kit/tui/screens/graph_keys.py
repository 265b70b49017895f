"""The keys of the graph screen in words, and how to read its picture."""

from __future__ import annotations

from typing import Final

from kit.tui.rows.key_rows import key_line, key_page

GRAPH_KEYS: Final = key_line(
    ("arrows", "choose"),
    ("Enter", "message"),
    ("/", "narrow"),
    ("a", "all"),
    ("t", "tidy"),
    ("p", "pause"),
    (".", "step"),
    ("?", "help"),
    ("Esc", "back"),
)

MESSAGE_KEYS: Final = key_line(
    ("arrows", "scroll"), ("p", "pause"), (".", "step"), ("?", "help"), ("Enter Esc", "back to the picture")
)

GRAPH_HELP: Final = key_page(
    (
        ("left", "the nodes that speak"),
        ("middle", "topics with their rates, services with ()"),
        ("right", "the nodes that listen, or answer"),
        ("a dot", "messages on their way; an answer goes back"),
        ("a cross", "nothing arrives: quality of service does not match"),
    ),
    (
        ("arrows, h j k l", "choose: thick lines, and the newest message below"),
        ("Enter", "the whole message, and each end's quality of service"),
        ("/", "only names with a text in them; Esc shows all again"),
        ("a", "also what ROS needs itself, and unused services"),
        ("t", "put all in order again; nothing else moves it"),
        ("p  .", "pause the world, and let it do one step"),
    ),
)
