"""How to do what a student does: drive, program, train, be checked, hand in."""

from __future__ import annotations

from typing import Final

from kit.document.blocks import Chapter
from kit.help.topic import HelpTopic, Shelf, chapter


def _chapters() -> tuple[Chapter, ...]:
    return (
        chapter(
            "Begin",
            """
`kit` opens a menu and a robot in a maze; W, A, S and D drive it. Enter begins the first lesson, or goes on where you left
off. `?` shows the keys of any screen, Ctrl-C leaves it.

    kit lesson
    kit lesson A1

Your files lie in `~/robot-kit`. Over SSH, `ssh -C` sends an eighth of the data. Where no full screen works, `--plain` goes
line by line; `kit doctor` says what was found, and why.
""",
        ),
        chapter(
            "Drive and look again",
            """
    kit drive maze
    kit run maze --seed 1 --record run.npz
    kit replay run.npz
    kit replay run.npz --check
    kit replay run.npz --export run.gif --speed 4

`kit maps` lists the maps, `kit maps maze` draws one. The same map, controller, steps and seed give the same run, bit for
bit: `--check` runs it again and compares every pose.
""",
        ),
        chapter(
            "Write a controller",
            """
The first start puts `my_controller.py` into `~/robot-kit/controllers`: an ordinary ROS 2 node. Edit it in your own editor
while `kit drive maze` is open; `c` lets it drive, and each time you save, the robot uses the new file.

    kit run maze --controller my_controller.py --steps 3000 --seed 1

An error ends only the controller, which runs in a process of its own; its place is shown.
""",
        ),
        chapter(
            "Get an exercise checked",
            """
Open the lesson; `c` checks the file, `h` gives a hint for the first criterion that you missed, `w` replays the worst run.
Saving the file checks it too.

    kit lesson A2

`kit progress` shows what is done. Nothing is lost when the line drops: each key is on the disk before the screen shows it.
""",
        ),
        chapter(
            "Train an agent",
            """
    kit train turn --name first --algo q-learning --steps 20000 --detach
    kit runs
    kit watch first
    kit evaluate first --episodes 20

A training is a process of its own: it goes on when you leave the screen or the line drops. `kit runs --stop first` stops it,
`kit train --resume first` goes on. Networks need the extra `learn`; `q-learning` and `sarsa` do not.

`kit task new mine --level left-turn` makes a task of a level of the game, and says how to train an agent by it and race it.
""",
        ),
        chapter(
            "Make a map",
            """
    kit maps new hall --from hall.txt
    kit drive ~/robot-kit/worlds/hall

`hall.txt` is a drawing: `#` is wall, `S` the start and `T` the target, a character is 0.5 m wide, or what `--cell` says.
`kit maps new hall` draws on the screen instead, `kit maps from-photo PICTURE --width METRES` reads a photograph of paper.
""",
        ),
        chapter(
            "Remember, and hand in",
            """
    kit quiz
    kit quiz --today
    kit quiz --scores
    kit glossary layer
    kit form
    kit progress export progress.json

The exported file holds your answers and results; it is what a teacher's class report reads.
""",
        ),
    )


TOPIC: Final = HelpTopic(
    "For students", "drive, write a controller, train, get checked, hand in", Shelf.HOW_TO, _chapters
)
