"""How to do what a ROS developer does: run a package, look inside, plan layers, record, go to a robot."""

from __future__ import annotations

from typing import Final

from kit.document.blocks import Chapter
from kit.help.topic import HelpTopic, Shelf, chapter


def _chapters() -> tuple[Chapter, ...]:
    return (
        chapter(
            "Run a package",
            """
A package runs from its source folder; nothing is built, and no ROS is installed. `import rclpy` gets the kit's own.

    kit pkg create my_robot
    kit launch my_robot --show-args
    kit launch my_robot --steps 500

Programs start in processes of their own. `kit ros run PACKAGE PROGRAM` runs one alone; a package is given by its name or its folder, and
`kit pkg executables` lists them.
""",
        ),
        chapter(
            "Look inside",
            """
Leave a world open in one terminal:

    kit run maze --serve --steps 100000

and ask from another, with the commands, arguments and output of `ros2`:

    kit ros node list
    kit ros topic list -t
    kit ros topic echo /odom --once
    kit ros topic hz /static_laser
    kit ros service call /pause std_srvs/srv/Empty
    kit ros param list

On a screen, `n` shows the nodes with the messages moving between them. `kit help messages` lists every interface.
""",
        ),
        chapter(
            "Check a world and plan its layers",
            """
    kit maps new hall --from hall.txt
    kit world check ~/robot-kit/worlds/hall/world.yaml
    kit layers plan ~/robot-kit/worlds/hall/world.yaml
    kit layers plan ~/robot-kit/worlds/hall/world.yaml --patch
    kit layers check ~/robot-kit/worlds/hall/world.yaml
    kit layers plan ~/robot-kit/worlds/hall/world.yaml --requirements > wanted.yaml
    kit layers plan wanted.yaml

`plan` finds the provably smallest set of collision layers that keeps what collides and what each laser sees; `--patch` prints
the change to the files, `--apply` makes it and loads them again. To have something
else collide, or another laser see it, edit what `--requirements` prints, and plan for that file. Robots with one model file share
their layers. `kit layers explain slides` shows the method step by step, `kit help world-format` every key.
""",
        ),
        chapter(
            "Record a bag",
            """
    kit run maze --steps 500 --bag first_bag
    kit ros bag info first_bag

ROS 2's own tools open it; `-s sqlite3` writes what Humble reads. `kit ros bag play` plays one into a running world.
""",
        ),
        chapter(
            "Go to a robot",
            """
The node file that drives here drives there. A trained policy becomes a node, or a package that colcon builds:

    kit train turn --name robot-1 --algo q-learning --steps 20000 --detach
    kit evaluate robot-1 --episodes 20 --latency 0:0.2 --wheel-radius=-0.1:0.1
    kit evaluate robot-1 --package my_agent

`kit bridge zenoh` and `kit bridge dds` connect the running world to a robot's ROS 2; both slow commands down to limits that
you set, and stop the robot when they end. Read `kit bridge zenoh --help` before the first drive. `kit bridge stop` stops all.
""",
        ),
        chapter(
            "What differs from ROS 2",
            """
- There is one graph on this machine; no domain, no discovery over a network, no build step.
- Time is the world's: `node.get_clock().now()` and `time.sleep()` follow it at any speed.
- A callback that takes long holds the world up in lock-step, as graded runs are; `kit drive` lets the world run on.
- What is absent says so when it is imported, with the nearest name that is there.
""",
        ),
    )


TOPIC: Final = HelpTopic(
    "For ROS developers",
    "run a package, look inside, plan layers, record, go to a robot",
    Shelf.HOW_TO,
    _chapters,
)
