"""Formats a bag's summary as ``ros2 bag info`` does."""

from __future__ import annotations

from datetime import UTC, datetime

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
        ("Bag size", [size_text(bag.size)]),
        ("Storage id", [bag.storage]),
        ("ROS Distro", [bag.distro]),
        ("Duration", [f"{_seconds(bag.duration_ns)}s"]),
        ("Start", [_instant(bag.start_ns)]),
        ("End", [_instant(end_ns)]),
        ("Messages", [str(bag.count)]),
        ("Topic information", topics),
    )
    lines = [""]
    for label, values in rows:
        first, *rest = values or [""]
        lines.append(f"{f'{label}:':<{LABEL_WIDTH}}{first}")
        lines += [" " * LABEL_WIDTH + value for value in rest]
    return "\n".join(lines)


def size_text(size: float) -> str:
    """``44.5 KiB``."""
    for unit in ("B", "KiB", "MiB", "GiB"):
        if size < 1024 or unit == "GiB":
            break
        size /= 1024
    return f"{size:.1f} {unit}"


def _seconds(time_ns: int) -> str:
    return f"{time_ns // 1_000_000_000}.{time_ns % 1_000_000_000:09d}"


def _instant(time_ns: int) -> str:
    """A time in UTC, since simulated time begins with 1970."""
    moment = datetime.fromtimestamp(time_ns // 1_000_000_000, UTC)
    return f"{moment:%b} {moment.day:2d} {moment:%Y %H:%M:%S}.{time_ns % 1_000_000_000:09d} ({_seconds(time_ns)})"
