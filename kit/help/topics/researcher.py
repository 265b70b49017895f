"""How to do what a researcher does: repeat the study, pose a task, train with many seeds, judge, compare."""

from __future__ import annotations

from typing import Final

from kit.document.blocks import Chapter
from kit.help.topic import HelpTopic, Shelf, chapter


def _chapters() -> tuple[Chapter, ...]:
    return (
        chapter(
            "Repeat the study",
            """
Each table and figure of the dissertation has its number; its printed cells stand beside ours.

    kit study
    kit study 3.5
    kit study 3.5 --csv tables
    kit study --check

`kit study 3.5 --again` trains its agents again; it prints first how long that takes.
""",
        ),
        chapter(
            "Pose a task of your own",
            """
    kit task new mine --from turn
    kit task keys
    kit task check mine
    kit task show mine
    kit train mine --name mine-1 --algo q-learning --steps 20000 --detach

A task is a YAML file: maps, robots, observation, actions, reward, goal, endings. `kit task check` tries loops of actions that
would earn without arriving. `kit task pack mine` makes one file to share. A reward in Python is a file with `reward()`, as in
`kit train turn --reward my_reward.py`.
""",
        ),
        chapter(
            "Train with many seeds",
            """
One training shows little. A sweep trains every combination and prints how many seeds have learned, with the interval that
contains the true share with 95 % confidence.

    kit sweep turn --seeds 2 --algos q-learning,sarsa --steps 20000 --episodes 20
    kit sweep turn --seeds 2 --algos q-learning,sarsa --steps 20000 --episodes 20 --executor none --json

The same command goes on after Ctrl-C. `--executor slurm` and `--executor dask` use a cluster, `--tune` searches settings,
`--crosstable` tests each agent on what it was not trained on.
""",
        ),
        chapter(
            "Judge and compare agents",
            """
    kit evaluate mine-1 --episodes 20
    kit evaluate mine-1 --episodes 20 --latency 0.2
    kit evaluate mine-1 --episodes 20 --pictures paths --paths 5
    kit train turn --name other-1 --algo sarsa --steps 20000 --detach
    kit compare mine-1 other-1 --episodes 20

`--sweep` shows how the success rate falls with each difference between simulation and robot. Test episodes are never those of
the training; the interval is Wilson's.
""",
        ),
        chapter(
            "From Python",
            """
`kit help environments` has the task cards, `kit help python` training with stable-baselines3, controllers run from a script
and recordings in NumPy. Everything below the screen takes a seed, and the same seed gives the same numbers on one machine.
""",
        ),
    )


TOPIC: Final = HelpTopic(
    "For researchers",
    "repeat the study, pose a task, train with many seeds, compare",
    Shelf.HOW_TO,
    _chapters,
)
