"""The study's summary, which README tells too: three tables, the finding, and the command under each."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from kit.document.blocks import (
    Block,
    Cell,
    CellStyle,
    Chapter,
    Column,
    Table,
    Text,
)
from kit.document.markdown import table_to_markdown
from kit.study.author_agents import read_author_agents
from kit.study.compared_means import compared_means_table
from kit.study.trained_again import trained_again_table

FINDING: Final = (
    "Why 4.1 and 4.2 rarely come out: the author's library takes values above 500 for equal. Side by side pays 10 a step, so good "
    "actions soon pass 500; then it explores by chance, and the values feed on each other without end. The prints are the best "
    "of up to 100 tests; printed adjacency largely measures how late ROS delivered commands."
)


def summary_chapter() -> Chapter:
    """What README tells, too: three tables, the finding, and the command under each."""
    blocks: list[Block] = []
    for table, command in summary_tables():
        blocks += [table, Text(command)]
    return Chapter("summary", "Summary", (*blocks, Text(FINDING)))


def summary_lines() -> list[str]:
    """What README tells of the study, as Markdown: tables, a sentence below each, and the finding."""
    lines: list[str] = []
    for table, sentence in summary_tables():
        rows = table_to_markdown(replace(table, note=""))
        lines += [line.replace(" | ", "|").replace("| ", "|").replace(" |", "|") for line in rows]
        lines += ["", sentence, ""]
    return [*lines, FINDING]


def summary_tables() -> tuple[tuple[Table, str], ...]:
    """Each with the sentence below it."""
    return (
        (
            _author_summary(),
            (
                "Recorded outside the kit, from his published networks; adjacency: share of steps side by side by rays. All: "
                "`kit study author`."
            ),
        ),
        (
            trained_again_table(),
            (
                "Seeds 0, 1, ...; each ends with a test of 0.8. Again: `kit study 4.1 --again --seeds 5`, or with `--no-limit`; values: "
                "`kit study clip`."
            ),
        ),
        (
            compared_means_table(),
            (
                "Means over cases (lowest-highest seed); adjacency of successful episodes. Again: `kit study 4.6 --again --kit`; all "
                "numbers checked: `kit study --check`."
            ),
        ),
    )


def _author_summary() -> Table:
    """What the published agents reach in the kit's own simulator."""
    titles = ("jitter [s]", "printed", "here", "adjacency", "here")
    columns = (
        Column("The author's agents", CellStyle.TEXT),
        *(Column(title, decimals=2) for title in titles),
    )
    rows: list[tuple[Cell, ...]] = [
        (
            f"{each.table}, {each.agent.partition(' (')[0].replace('_', ' ')}",
            *(each.jitter_s, each.printed_success, each.success, each.printed_adjacency, each.adjacency),
        )
        for each in read_author_agents()
        if each.where.startswith("full simulator")
    ]
    return Table("author-summary", "", columns, tuple(rows))
