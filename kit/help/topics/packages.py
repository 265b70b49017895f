"""How a package of one's own brings parts to the kit."""

from __future__ import annotations

from typing import Final

from kit.document.blocks import CellStyle, Chapter, Code, Column, Table
from kit.extensions import FOLDERS, GROUPS, IMPORT_LIMIT_S, PREFIX
from kit.help.topic import HelpTopic, Shelf, chapter

EXAMPLE: Final = f"""\
[project.entry-points."{PREFIX}devices"]
Compass = "example_parts.compass:PLUGIN_TYPE"

[project.entry-points."{PREFIX}maps"]
maps = "example_parts.maps"
"""


def _chapters() -> tuple[Chapter, ...]:
    columns = (Column("Group", CellStyle.TEXT), Column("An entry is", CellStyle.TEXT))
    return (
        chapter(
            "Parts of your own",
            """
Any installed package can bring parts, which are then used like the kit's own: worlds may hold its devices, `kit maps` lists its
maps, `kit` has its verbs. The package names them as entry points in its `pyproject.toml`:
""",
            Code(tuple(EXAMPLE.splitlines())),
            Table(
                "groups",
                f"Groups; each begins with {PREFIX}",
                columns,
                tuple(GROUPS.items()),
                note=f"Of {', '.join(FOLDERS)} the value is a folder, package.folder, which is read and never imported; "
                "of the others module:object.",
            ),
            """
`tests/extensions/example_package` in the kit's source is a package that brings one part of each group, in a few lines each.
""",
        ),
        chapter(
            "What is found",
            f"""
`kit doctor` lists every part, the package that it is from, and whether it works. Looking imports nothing; a part is imported when
it is first named.

- A part that raises an error, or whose import takes more than {IMPORT_LIMIT_S:g} seconds, is left out, and named where it is asked for.
- Of two parts of one name both are left out; a name of the kit's own is always the kit's.
- Removing the package removes its parts; the kit keeps nothing of them.
""",
        ),
        chapter(
            "While others' work is graded",
            """
A grader loads no part but those of the packages that the assignment's sheet names:

    packages: [example-parts]

Every machine that grades needs these packages, in the same version: workers of a cluster, and CI. A changed version makes results
of the earlier one out of date. Their devices are loaded before the process that reads a submission is confined; a student's own
program never sees them.
""",
        ),
    )


TOPIC: Final = HelpTopic(
    "Parts of your own package", "bring devices, maps, lessons, checks, verbs", Shelf.HOW_TO, _chapters
)
