"""What ``kit ros bag info`` prints."""

from __future__ import annotations

from datetime import UTC, datetime

from kit.plain_text import format_size
from kit.ros.bags import Bag

LABEL_WIDTH = 19


def bag_info(bag: Bag) -> str:
    """The output of ``bag info``, which begins with an empty line."""
    end_ns = bag.start_ns + bag.duration_ns
    topics = [
        f"Topic: {topic.name} | Type: {topic.type} | Count: {topic.count} | "
        f"Serialization Format: {topic.serialization}"
        for topic in bag.topics
    ]
    rows: tuple[tuple[str, list[str]], ...] = (
        ("Files", list(bag.files)),
        ("Bag size", [format_size(bag.size)]),
        ("Storage id", [bag.storage]),
        ("ROS Distro", [bag.distro]),
        ("Duration", [f"{_seconds_text(bag.duration_ns)}s"]),
        ("Start", [_utc_text(bag.start_ns)]),
        ("End", [_utc_text(end_ns)]),
        ("Messages", [str(bag.count)]),
        ("Topic information", topics),
    )
    lines = [""]
    for label, values in rows:
        first, *rest = values or [""]
        lines.append(f"{f'{label}:':<{LABEL_WIDTH}}{first}")
        lines += [" " * LABEL_WIDTH + value for value in rest]
    return "\n".join(lines)


def _seconds_text(time_ns: int) -> str:
    return f"{time_ns // 1_000_000_000}.{time_ns % 1_000_000_000:09d}"


def _utc_text(time_ns: int) -> str:
    """A time in UTC, since simulated time begins with 1970."""
    moment = datetime.fromtimestamp(time_ns // 1_000_000_000, UTC)
    return f"{moment:%b} {moment.day:2d} {moment:%Y %H:%M:%S}.{time_ns % 1_000_000_000:09d} ({_seconds_text(time_ns)})"
