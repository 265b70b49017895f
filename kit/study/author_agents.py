"""What the dissertation's own published agents reach in the kit's simulator, as it was recorded outside the kit.

His networks are files of another library in a repository without a licence: they do not come with the kit, so no command of
the kit drives them. Each row of the file beside this module says what drove, where, and over how many episodes.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from kit.document.blocks import Cell, CellStyle, Column, Table

AGENTS_FILE: Final = Path(__file__).with_name("author_agents.csv")
FIELDS: Final = (
    *("agent", "table", "printed_success", "printed_adjacency", "jitter_s"),
    *("success", "adjacency", "episodes", "where"),
)


class AuthorAgentsError(Exception):
    """The file cannot be read; the message names the line."""


@dataclass(frozen=True, slots=True)
class AuthorAgentResult:
    """What one agent, or several together, reached under one condition. None: not measured, or not printed."""

    agent: str
    table: str
    """The printed table's number."""
    printed_success: float | None
    printed_adjacency: float | None
    jitter_s: float | None
    """Up to which each robot's command was late after each scan, by itself [s]."""
    success: float | None
    adjacency: float | None
    """Share of steps side by side by rays."""
    episodes: str
    """How many, or of what."""
    where: str
    """The simulator and the world."""


def read_author_agents(file: Path = AGENTS_FILE) -> tuple[AuthorAgentResult, ...]:
    """Raises AuthorAgentsError."""
    found = []
    with file.open(encoding="utf-8", newline="") as lines:
        reader = csv.DictReader(lines)
        if tuple(reader.fieldnames or ()) != FIELDS:
            raise AuthorAgentsError(f"{file}, line 1: the columns must be {', '.join(FIELDS)}.")
        for each in reader:
            try:
                found.append(_read_result(each))
            except (TypeError, ValueError) as error:
                raise AuthorAgentsError(f"{file}, line {reader.line_num}: {error}.") from None
    return tuple(found)


def _read_result(row: dict[str, str]) -> AuthorAgentResult:
    """TypeError or ValueError if something is missing or no number."""
    agent, table, episodes, where = (row[name] for name in ("agent", "table", "episodes", "where"))
    if not all((agent, table, episodes, where)):
        raise ValueError("agent, table, episodes and where must be told")
    printed_success, printed_adjacency, jitter_s, success, adjacency = (
        float(row[name]) if row[name] else None for name in FIELDS[2:7]
    )
    return AuthorAgentResult(
        agent, table, printed_success, printed_adjacency, jitter_s, success, adjacency, episodes, where
    )


def author_agents_table() -> Table:
    """One row for each result."""
    columns = (
        Column("agent", CellStyle.TEXT),
        Column("table", CellStyle.TEXT),
        Column("printed", decimals=2),
        Column("adj", decimals=2),
        Column("jitter [s]", decimals=2),
        Column("here", decimals=2),
        Column("adj", decimals=2),
        Column("episodes", CellStyle.TEXT),
        Column("where", CellStyle.TEXT),
    )
    rows = tuple(map(_result_cells, read_author_agents()))
    return Table("author-agents", "", columns, rows, note=AUTHOR_NOTE)


AUTHOR_NOTE: Final = (
    "Recorded outside the kit, from his published networks. adj: share of steps side by side by rays, printed, then here. "
    "jitter: each wheelchair's command was late by 0 to this many seconds after each scan, by itself, as ROS's were; with 0 both "
    "wheelchairs' steps are equally long. The printed adjacency largely measures this: 0.96 without it is 0.24 with it for "
    "an agent that only ever drives both ahead."
)


def _result_cells(each: AuthorAgentResult) -> tuple[Cell, ...]:
    printed = (each.printed_success, each.printed_adjacency)
    here = (each.jitter_s, each.success, each.adjacency)
    return (each.agent, each.table, *printed, *here, each.episodes, each.where)
