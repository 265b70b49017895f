"""Starting and ending: the default context, and signals in a program that stands alone."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Iterator

import pytest

from kit.ros.exceptions import NotInitializedException
from kit.ros.execution import client_library as rclpy
from kit.ros.execution.context import Context, get_default_context, set_default_graph
from kit.ros.graph.graph import Graph


@pytest.fixture
def default(graph: Graph) -> Iterator[Graph]:
    """A simulated graph behind the default context."""
    set_default_graph(graph)
    yield graph
    set_default_graph(None)


class TestLife:
    def test_from_init_to_shutdown_and_again(self, default: Graph) -> None:
        for _ in range(2):
            assert not rclpy.ok()
            rclpy.init(args=[])
            assert rclpy.ok()
            node = rclpy.create_node("node", namespace="/ns")
            assert node.context is get_default_context()
            assert node.get_fully_qualified_name() == "/ns/node"
            node.destroy_node()
            rclpy.shutdown()
            assert not rclpy.ok()

    def test_init_twice(self, default: Graph) -> None:
        rclpy.init(args=[])
        with pytest.raises(RuntimeError, match="must only be called once"):
            rclpy.init(args=[])

    def test_shutdown_without_init(self, default: Graph) -> None:
        with pytest.raises(RuntimeError):
            rclpy.shutdown()
        rclpy.try_shutdown()

    def test_a_node_before_init(self, default: Graph) -> None:
        with pytest.raises(NotInitializedException, match=r"rclpy\.init\(\) has not been called"):
            rclpy.create_node("early")

    def test_init_as_a_context_manager(self, default: Graph) -> None:
        with rclpy.init(args=[]):
            assert rclpy.ok()
        assert not rclpy.ok()

    def test_a_context_of_ones_own(self, graph: Graph) -> None:
        context = Context(graph)
        rclpy.init(args=[], context=context)
        assert rclpy.ok(context=context)
        ended: list[str] = []
        context.on_shutdown(lambda: ended.append("ended"))
        rclpy.shutdown(context=context)
        context.on_shutdown(lambda: ended.append("at once"))
        assert ended == ["ended", "at once"]
        with pytest.raises(TypeError):
            context.on_shutdown("no function")

    def test_domain_ids(self, graph: Graph) -> None:
        with pytest.raises(RuntimeError, match="zero"):
            rclpy.init(args=[], context=Context(graph), domain_id=-1)
        context = Context(graph)
        rclpy.init(args=[], context=context, domain_id=7)
        assert context.get_domain_id() == 7

    def test_the_programs_own_arguments(self) -> None:
        assert rclpy.remove_ros_args(["prog", "x", "--ros-args", "-r", "a:=b", "--", "y"]) == [
            "prog",
            "x",
            "y",
        ]

    def test_the_global_executor_is_one_per_context(self, default: Graph) -> None:
        rclpy.init(args=[])
        assert rclpy.get_global_executor() is rclpy.get_global_executor()


PROGRAM = """
import sys
import kit.ros; kit.ros.install_import_names()
import rclpy
from rclpy.executors import ExternalShutdownException
def say(line):  # in one piece: callbacks of other threads say something too
    sys.stdout.write(line + "\\n")
    sys.stdout.flush()
rclpy.init(args=[])
node = rclpy.create_node("node")
node.create_timer(0.01, lambda: say("tick"))
try:
    {spin}
except KeyboardInterrupt:
    say(f"interrupted {{rclpy.ok()}}")
except ExternalShutdownException:
    say(f"shut down {{rclpy.ok()}}")
finally:
    node.destroy_node()
    rclpy.shutdown()
    say("clean")
"""

SPINS = {
    "spin": "rclpy.spin(node)",
    "spin_once": "while rclpy.ok(): rclpy.spin_once(node)",
    "rate": "rate = node.create_rate(1)\n    say('tick')\n    while rclpy.ok(): rate.sleep()",
    "service": "say('tick')\n    from std_srvs.srv import Trigger; node.create_client(Trigger, 'x').wait_for_service()",
    "many": "from rclpy.executors import MultiThreadedExecutor as M; e = M(2); e.add_node(node); e.spin()",
}


@pytest.mark.parametrize("spin", sorted(SPINS))
@pytest.mark.parametrize(
    ("number", "said"), [(signal.SIGINT, "interrupted False"), (signal.SIGTERM, "shut down False")]
)
def test_signals_end_a_program_in_good_order(spin: str, number: signal.Signals, said: str) -> None:
    code = PROGRAM.format(spin=SPINS[spin])
    process = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "tick\n"
    time.sleep(0.05)
    process.send_signal(number)
    output, errors = process.communicate(timeout=10)
    lines = [line for line in output.splitlines() if line != "tick"]
    if spin in ("spin_once", "service", "rate") and number == signal.SIGTERM:
        assert lines[-1:] == ["clean"], errors
    else:
        assert lines == [said, "clean"], errors


def test_the_domain_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    for given, expected in ((None, 7), (3, 3)):
        context = Context()
        context.init(None, domain_id=given)
        assert context.get_domain_id() == expected
        context.shutdown()
    monkeypatch.setenv("ROS_DOMAIN_ID", "seven")
    with pytest.raises(RuntimeError, match="seven"):
        Context().init(None)
