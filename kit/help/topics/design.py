"""The design and its reasons, for whoever carries the kit on."""

from __future__ import annotations

from typing import Final

from kit.document.blocks import CellStyle, Chapter, Column, Picture, Table
from kit.help.topic import HelpTopic, Shelf, chapter

DRAWING: Final = """
8  faces         kit/cli/  one command a module   kit/tui/  screens, keys
                 grader/   beside: the kit never imports it
                 kit/program   what the installed kit begins with
7  pages         kit/help/  one topic a file
6  school        kit/school/  lessons quiz survey game report progress
                 kit/study/   the dissertation's tables
5  learning      kit/learning/  environment/ training/ policies/ tasks/
                 kit/layers/    the layer planner
4  running       kit/run/  runner (the tick) episode recording metrics
                 kit/host/  student processes     kit/bridge/  robots
                 kit/launch/  launch files        kit/inspection/  terminals
                 kit/document/  what is told      kit/dialogue/  what is asked
                 kit/render/  state -> characters kit/results/  of gradings
                 kit/controllers/  node files     kit/mapmaking/  photo -> map
3  conversation  kit/ros/  graph node parameters execution launch
                 kit/fields/  potential fields
2  motion        kit/sim/  simulation, plugins/ one device a file
1  description   kit/world/  records, YAML reader, walls, who touches whom
0  numbers       kit/kernels/ (numba)   kit/msg/ (ROS)   kit/geometry
                 kit/arrays  kit/workspace  kit/plain_text  kit/part_file
                 kit/environment_ids  kit/interruption  kit/plain_files
                 kit/array_archives  kit/field_types  kit/installation
                 kit/extensions  (others' packages)   kit/blas
                 kit/breadth_first  kit/line_log  kit/segments
                 kit/yaml_numbers  kit/yaml_slips
"""
"""The rooms of the kit, floor by floor; an import only goes down."""

CHOICES: Final = (
    (
        "An import only goes down, and a program checks it",
        "whoever changes a floor knows what cannot be affected; `pyproject.toml` holds the rules",
    ),
    (
        "sim and ros do not know each other",
        "a world without programs and programs without a world can each be tested; only the runner joins them",
    ),
    (
        "One tick, one episode",
        "playing, racing, training's tests, a lesson and a grade are one loop looked at by others, so they cannot disagree",
    ),
    (
        "Every formula once, as a scalar compiled function",
        "one world and many run the same numbers; a test compares both engines on every map",
    ),
    (
        "The batch engine refuses what it cannot represent",
        "a world that is trained slightly wrong is worse than one that is refused by the name of the feature",
    ),
    (
        "A recording is world, seed and inputs",
        "a copied physics space does not go on the same (measured); a run that is done again does, bit for bit",
    ),
    (
        "A student's program has a process of its own, always",
        "it can neither stop nor see the grader, and a desk grades as a cluster does",
    ),
    (
        "YAML as nodes with line and column",
        "all mistakes of all files at once, each with its place; duplicate keys refused; `no` and `1e-3` as YAML 1.2 has them",
    ),
    (
        "HiGHS for the fewest layers",
        "networkx finds the cliques, but has no exact edge clique cover; HiGHS proves the minimum in milliseconds",
    ),
    (
        "stable-baselines3, not our own algorithms",
        "a well-kept library is better outside what the kit exists for; only what lessons open up is written here",
    ),
    (
        "torch in an extra",
        "a grader in CI and a layer planner install in seconds; a plain install of torch brings gigabytes of CUDA",
    ),
    (
        "A drawing of our own for the moving world",
        "dots that changed are sent, 3 KB/s in place of 160 KB/s over SSH (measured)",
    ),
    (
        "Of Textual only inputs, text areas and pickers",
        "its tables and lists cost three to ten times the bytes of a key (measured); rows are the kit's own",
    ),
    (
        "textual pinned exactly",
        "key release needs its driver and its parser; one contract test for each private name",
    ),
    (
        "What is told is blocks, what asks is a dialogue",
        "a screen, a pipe, a screen reader and these pages say the same, because it stands once",
    ),
    (
        "A kind is a file, found by a registry",
        "a new device, check, kind, topic or verb touches one file, and a contract test finds it unasked",
    ),
    (
        "SQLite for progress, local processes for grading",
        "nothing to install and nothing to keep alive; SLURM and Dask when one machine is too small",
    ),
)
"""Choice and reason."""


def _chapters() -> tuple[Chapter, ...]:
    columns = (Column("Choice", CellStyle.TEXT), Column("Reason", CellStyle.TEXT))
    choices = tuple((choice, reason.replace("`", "")) for choice, reason in CHOICES)
    return (
        chapter(
            "The main loop",
            """
One `tick` in `kit/run/runner.py`, which fits on a screen: callbacks that are due, their commands, devices before the step,
physics by a fixed time, devices after the step, whose messages it publishes, observers. `kit/run/episode.py` puts a controller
into a scenario, calls it until the episode ends, and measures. How fast the wall clock runs is the caller's business.

The same world, seed and inputs give the same run, to the bit, on one platform.
""",
        ),
        chapter(
            "Floors",
            "Two wings stand on the ground and do not know each other: what is (`kit/world`, `kit/sim`) and what is said "
            "(`kit/ros`). A student's process imports only `kit.ros`, `kit.msg` and `kit.host`, so that it starts fast.",
            Picture(tuple(DRAWING.strip().splitlines()), indent=0),
        ),
        chapter("Choices and their reasons", Table("choices", "", columns, choices)),
        chapter(
            "Processes and the disk",
            """
- The face, the world's thread, each student's program, each check, each training and each bridge to a robot are apart; none
  holds up another, and a training outlives the face.
- A workspace (`~/robot-kit`, readable by its owner alone) holds everything of a user's; nothing is written outside it but
  caches.
- Every write is whole or not at all. Whatever ends a program, what was recorded so far is kept, and said.
- No number and no word of a student's process decides how long the grader works or how it judges.
""",
        ),
        chapter(
            "Versions",
            """
From 0.2.0 on, a version reads what the ones before it wrote with the same first two numbers: progress files, recordings,
policies, tasks, worlds, assignments and results. A change that breaks this raises the second number, is in
`.github/CHANGELOG.md`, and names the command that converts, or says that there is none. Environments carry versions of their
own: `RobotKit/Turn-v0` becomes `-v1` when the same actions would earn something else.

Files of versions before 0.2.0 are not read.
""",
        ),
        chapter(
            "Where to go on",
            """
`.github/CONTRIBUTING.md` has walks through the code, how to test, how to name and how to add each kind of thing;
`.github/SECURITY.md` what each confinement level promises. `kit help packages` is for parts in a package of your own.
""",
        ),
    )


TOPIC: Final = HelpTopic(
    "The design and its reasons", "floors, the main loop, choices and why", Shelf.BACKGROUND, _chapters
)
