"""One program by itself: beside a running world, alone, and together with another."""

from __future__ import annotations

import signal
from contextlib import ExitStack
from pathlib import Path

import pytest

from kit.inspection.client import InspectionClient
from kit.inspection.sockets import running_worlds, sockets_folder
from tests.launch.conftest import Workshop, kit
from tests.run.test_connection_watch import DEAF, SAID
from tests.waiting import wait_until

HELLO = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import String

class Hello(Node):
    def __init__(self):
        super().__init__("hello")
        self.declare_parameter("word", "hello")
        self.out = self.create_publisher(String, "words", 10)
        self.create_timer(0.05, self.speak)

    def speak(self):
        self.out.publish(String(data=self.get_parameter("word").value))
"""

HEAR = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import String

class Hear(Node):
    def __init__(self):
        super().__init__("hear")
        self.create_subscription(String, "words", self.hear, 10)

    def hear(self, message):
        print("heard", message.data, self.get_clock().now().nanoseconds > 0)
"""


@pytest.mark.long
def test_two_programs_in_two_terminals_hear_each_other(tmp_path: Path) -> None:
    """The first runs alone, in real time; the second finds it and joins."""
    workspace = tmp_path / "workspace"
    (tmp_path / "hello.py").write_text(HELLO)
    (tmp_path / "hear.py").write_text(HEAR)
    with kit(workspace, "ros", "run", tmp_path / "hello.py", "--ros-args", "-p", "word:=bonjour") as first:
        wait_until(lambda: running_worlds(sockets_folder(workspace)))
        with kit(workspace, "ros", "run", tmp_path / "hear.py") as second:
            assert second.stdout is not None
            assert [second.stdout.readline() for _ in range(3)] == ["heard bonjour True\n"] * 3
            with InspectionClient(running_worlds(sockets_folder(workspace))[0]) as visit:
                names = {handle.full_name for handle in visit.graph.directory.nodes}
            assert {"/hello", "/hear"} <= names
            second.send_signal(signal.SIGINT)
            rest, _ = second.communicate(timeout=10)
            assert "Traceback" not in rest
            assert second.returncode == 130
        first.send_signal(signal.SIGINT)
        rest, _ = first.communicate(timeout=10)
        assert (rest, first.returncode) == ("", 130)
    assert not list((workspace / ".running").rglob("*.sock"))


@pytest.mark.long
@pytest.mark.parametrize("beside", [True, False])
def test_a_program_that_hears_nothing_is_told_of(beside: bool, tmp_path: Path) -> None:
    """Beside a world with what there is, alone that there is nothing; once, and without an end of the program."""
    workspace = tmp_path / "workspace"
    (tmp_path / "deaf.py").write_text(DEAF)
    with ExitStack() as stack:
        if beside:
            world = stack.enter_context(
                kit(workspace, "run", "turtlebot", "--serve", "--steps", "100000", "--speed", "2")
            )
            stack.callback(world.send_signal, signal.SIGINT)
            wait_until(lambda: running_worlds(sockets_folder(workspace)))
        with kit(workspace, "ros", "run", tmp_path / "deaf.py") as program:
            assert program.stdout is not None
            told = [program.stdout.readline() for _ in (SAID if beside else SAID[:1])]
            program.send_signal(signal.SIGINT)
            rest, _ = program.communicate(timeout=10)
    assert program.returncode == 130
    for line, (named, there_is) in zip(told, SAID, strict=False):
        assert line.index(named) < line.index("/deaf")
        assert (f" {there_is} " in line) == beside
    assert "/deaf" not in rest


LEAVES = """
import rclpy
from rclpy.node import Node

class Leaves(Node):
    def __init__(self):
        super().__init__("leaves")
        self.create_timer(0.05, self.leave)

    def leave(self):
        print("leaves")
        raise SystemExit(CODE)

def main():
    rclpy.init()
    rclpy.spin(Leaves())

if __name__ == "__main__":
    main()
"""


@pytest.mark.long
@pytest.mark.parametrize(("code", "status"), [("", 0), ("0", 0), ("3", 3)])
def test_a_callback_may_end_the_program(code: str, status: int, tmp_path: Path) -> None:
    """``raise SystemExit`` in a callback is how many tutorials end a node."""
    (tmp_path / "leaves.py").write_text(LEAVES.replace("CODE", code))
    with kit(tmp_path / "workspace", "ros", "run", tmp_path / "leaves.py") as running:
        said, _ = running.communicate(timeout=60)
    assert running.returncode == status, said
    assert "leaves" in said
    assert ("exited with" in said) == bool(status)


@pytest.mark.parametrize(
    "guard", ["if __name__ == '__main__':\n    main()", ""], ids=["asks for its name", "does not"]
)
@pytest.mark.long
def test_a_program_need_not_make_a_node(guard: str, tmp_path: Path) -> None:
    """As the first one of a new package, which only says hello: its main() is called once."""
    (tmp_path / "hi.py").write_text(f"def main():\n    print('Hi from my_package.')\n\n{guard}\n")
    with kit(tmp_path / "workspace", "ros", "run", tmp_path / "hi.py") as program:
        said, _ = program.communicate(timeout=60)
    assert (said, program.returncode) == ("Hi from my_package.\n", 0)


def test_a_missing_module_is_explained(tmp_path: Path) -> None:
    (tmp_path / "sees.py").write_text("from cv_bridge import CvBridge\n")
    with kit(tmp_path / "workspace", "ros", "run", tmp_path / "sees.py") as running:
        said, _ = running.communicate(timeout=60)
    assert running.returncode == 1
    assert "sees.py:1: " in said
    assert "cv_bridge is not in the kit" in said


@pytest.mark.long
def test_a_package_s_program_runs_beside_a_world(workshop: Workshop, tmp_path: Path) -> None:
    """In the world's time, with the world's services; the world goes on when it has ended."""
    folder = workshop.package(
        "visitor",
        "",
        mover="""
        from flatland_msgs.srv import MoveModel
        from geometry_msgs.msg import Pose2D
        client = self.create_client(MoveModel, "/move_model")
        client.wait_for_service()
        future = client.call_async(MoveModel.Request(name="nobody", pose=Pose2D()))
        rclpy.spin_until_future_complete(self, future)
        print(future.result().message, self.get_clock().now().nanoseconds > 0)
        raise SystemExit(0)
        """,
    )
    source = folder / "visitor" / "mover.py"
    source.write_text(
        source.read_text().replace("rclpy.spin(Mover())", "Mover()").replace("raise SystemExit(0)", "")
    )
    workspace = tmp_path / "workspace"
    with kit(workspace, "run", "simple", "--serve", "--steps", "100000") as world:
        wait_until(lambda: running_worlds(sockets_folder(workspace)))
        (workspace / "packages").mkdir(parents=True, exist_ok=True)
        (workspace / "packages" / "visitor").symlink_to(folder)
        with kit(workspace, "ros", "run", "visitor", "mover") as visitor:
            said, _ = visitor.communicate(timeout=30)
        assert 'model with name "nobody" does not exist True' in said
        assert visitor.returncode == 0
        with kit(workspace, "ros", "node", "list") as listing:
            assert "/flatland_server" in listing.communicate(timeout=30)[0]
        with kit(workspace, "ros", "run", "visitor", "nothing") as wrong:
            assert "has no executable 'nothing'; it has: mover" in wrong.communicate(timeout=30)[0]
        assert wrong.returncode == 2
        with kit(workspace, "ros", "run", tmp_path / "none.py") as wrong:
            assert "none.py" in wrong.communicate(timeout=30)[0]
        assert wrong.returncode == 2
        world.send_signal(signal.SIGINT)
        summary, _ = world.communicate(timeout=30)
    assert "fingerprint" in summary


@pytest.mark.long
def test_a_run_keeps_a_bag(tmp_path: Path) -> None:
    from kit.ros.bags import read_bag

    with kit(
        tmp_path / "workspace", "run", "simple", "--steps", "100", "--bag", tmp_path / "bag", "-s", "sqlite3"
    ) as run:
        run.communicate(timeout=60)
    assert run.returncode == 0
    bag = read_bag(tmp_path / "bag")
    assert {topic.name: topic.count for topic in bag.topics}["/static_laser"] == 10
    assert bag.storage == "sqlite3"
    with kit(tmp_path / "workspace", "run", "simple", "--steps", "1", "--bag", tmp_path / "bag") as again:
        assert "already exists" in again.communicate(timeout=60)[0]
    assert again.returncode == 2
