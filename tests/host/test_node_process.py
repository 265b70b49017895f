"""Student nodes as processes: they take part in the graph as if they were in it."""

from __future__ import annotations

import dataclasses
import math
import re
import time
from array import array
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from kit.host.failure import FailureKind, StudentCodeError
from kit.host.node_process import NodeProcess
from kit.msg.geometry_msgs import Twist
from kit.msg.nav_msgs import Odometry
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_msgs import String
from kit.msg.std_srvs import SetBool, Trigger
from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node, create_graph_node
from kit.ros.node.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from tests.host.conftest import QUICK, Student
from tests.waiting import wait_until

TICK_NS = 100_000_000

ECHO = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import String

class Echo(Node):
    def __init__(self):
        super().__init__("echo")
        self.back = self.create_publisher(String, "answers", 10)
        self.create_subscription(String, "questions", self.on_question, 10)

    def on_question(self, message):
        self.back.publish(String(data=message.data.upper()))
"""

MAIN = """
def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Echo())
"""

GUARD = """
if __name__ == "__main__":
    main()
"""


class GraphHarness:
    """A graph with one node of the test's, and a clock."""

    def __init__(self) -> None:
        self.graph = Graph(log_sink=lambda record: self.log.append(record.text))
        self.log: list[str] = []
        self.node: Node = create_graph_node(self.graph, "checker")
        self.received: list[Any] = []
        self.processes: list[NodeProcess] = []
        self._publishers: dict[str, Any] = {}

    def start(self, file: Path, **options: Any) -> NodeProcess:
        process = NodeProcess.start(self.graph, file, **{"limits": QUICK, **options})
        self.processes.append(process)
        self.run_until_idle()
        return process

    def subscribe(self, cls: Any, topic: str, qos: QoSProfile | int = 10) -> list[Any]:
        received: list[Any] = []
        self.node.create_subscription(cls, topic, received.append, qos)
        return received

    def publish(self, topic: str, message: Any) -> None:
        if topic not in self._publishers:
            self._publishers[topic] = self.node.create_publisher(type(message), topic, 10)
        self._publishers[topic].publish(message)
        self.run_until_idle()

    def run_until_idle(self) -> None:
        """Does what the runner does in each tick."""
        for _ in range(100):
            self.graph.run_due()
            exchanged = [process.exchange() for process in self.processes]
            if not any(exchanged):
                return
        raise AssertionError("they exchange messages without end")

    def tick(self, count: int = 1) -> None:
        for _ in range(count):
            self.graph.advance(self.graph.now_ns + TICK_NS)
            self.run_until_idle()


@pytest.fixture
def harness() -> Iterator[GraphHarness]:
    made = GraphHarness()
    yield made
    for process in made.processes:
        process.close()


def texts(messages: list[Any]) -> list[str]:
    return [message.data for message in messages]


@pytest.mark.parametrize(
    "source",
    [ECHO, ECHO + MAIN, ECHO + MAIN + GUARD, ECHO + "rclpy.init()\nrclpy.spin(Echo())"],
    ids=["class", "main", "guard", "script"],
)
def test_every_way_to_write_a_node_file_is_the_same(
    harness: GraphHarness, student: Student, source: str
) -> None:
    answers = harness.subscribe(String, "/answers")
    process = harness.start(student(source))
    harness.publish("/questions", String(data="why"))
    harness.publish("/questions", String(data="how"))
    assert texts(answers) == ["WHY", "HOW"]
    assert process.failure is None
    assert process.is_running


def test_a_topic_with_messages_of_two_types(harness: GraphHarness, student: Student) -> None:
    """The wrong type is told and reaches nobody, and the right one arrives: the mismatch is logged while the publisher is
    made, and that log is a message itself."""
    answers = harness.subscribe(String, "/answers")
    both = ECHO.replace(
        'self.back = self.create_publisher(String, "answers", 10)',
        'self.back = self.create_publisher(String, "answers", 10)\n'
        '        self.wrong = self.create_publisher(Twist, "answers", 10)',
    ).replace("        self.back.publish", "        self.wrong.publish(Twist())\n        self.back.publish")
    process = harness.start(student("from geometry_msgs.msg import Twist\n" + both))
    harness.publish("/questions", String(data="why"))
    harness.publish("/questions", String(data="how"))
    assert process.failure is None
    assert texts(answers) == ["WHY", "HOW"]


def test_question_and_answer_take_no_time(harness: GraphHarness, student: Student) -> None:
    """Ours -> student's -> other student's -> ours, all at one instant."""
    answers = harness.subscribe(String, "/answers")
    harness.start(student(ECHO.replace('"answers"', '"halfway"')))
    second = ECHO.replace('"questions"', '"halfway"').replace("upper", "title").replace('"echo"', '"second"')
    harness.start(student(second, "second.py"))
    before = harness.graph.now_ns
    harness.publish("/questions", String(data="why not"))
    assert texts(answers) == ["Why Not"]
    assert harness.graph.now_ns == before


def test_the_graph_shows_a_process_as_it_is(harness: GraphHarness, student: Student) -> None:
    file = student(
        """
        import rclpy
        from rclpy.node import Node
        from rclpy.qos import qos_profile_sensor_data
        from geometry_msgs.msg import Twist
        from sensor_msgs.msg import LaserScan
        from std_srvs.srv import Trigger, SetBool

        class Mine(Node):
            def __init__(self):
                super().__init__("mine", namespace="robot")
                self.create_publisher(Twist, "cmd_vel", 7)
                self.create_subscription(LaserScan, "/scan", print, qos_profile_sensor_data)
                self.create_service(Trigger, "~/go", lambda q, a: a)
                self.create_client(SetBool, "/toggle")
        """
    )
    process = harness.start(file)
    view = harness.node
    assert ("mine", "/robot") in view.get_node_names_and_namespaces()
    assert ("/robot/cmd_vel", ["geometry_msgs/msg/Twist"]) in view.get_publisher_names_and_types_by_node(
        "mine", "/robot"
    )
    (publisher,) = view.get_publishers_info_by_topic("/robot/cmd_vel")
    assert publisher.qos_profile.depth == 7
    (subscription,) = view.get_subscriptions_info_by_topic("/scan")
    assert subscription.qos_profile.is_best_effort == qos_profile_sensor_data.is_best_effort
    services = dict(view.get_service_names_and_types())
    assert services["/robot/mine/go"] == ["std_srvs/srv/Trigger"]
    assert "/robot/mine/get_parameters" in services
    assert ("/toggle", ["std_srvs/srv/SetBool"]) in view.get_client_names_and_types_by_node("mine", "/robot")
    process.close()
    assert view.get_node_names() == ["checker"]
    assert not view.count_publishers("/robot/cmd_vel")


def test_a_process_sees_the_graph(harness: GraphHarness, student: Student) -> None:
    answers = harness.subscribe(String, "/answers")
    harness.node.create_service(Trigger, "/ours", lambda request, response: response)
    file = student(
        ECHO.replace(
            "message.data.upper()",
            "repr((sorted(self.get_node_names()), self.count_subscribers('/answers'),"
            " self.count_publishers('/questions'), '/ours' in dict(self.get_service_names_and_types())))",
        )
    )
    harness.start(file)
    harness.publish("/questions", String())
    late = create_graph_node(harness.graph, "late")
    harness.publish("/questions", String())
    late.destroy_node()
    harness.publish("/questions", String())
    without = repr((["checker", "echo"], 1, 1, True))
    assert texts(answers) == [without, repr((["checker", "echo", "late"], 1, 1, True)), without]


def test_endpoints_that_come_and_go_later(harness: GraphHarness, student: Student) -> None:
    file = student(
        """
        import rclpy
        from rclpy.node import Node
        from std_msgs.msg import String

        class Changing(Node):
            def __init__(self):
                super().__init__("changing")
                self.extra = None
                self.create_subscription(String, "orders", self.on_order, 10)

            def on_order(self, message):
                if message.data == "open":
                    self.extra = self.create_publisher(String, "extra", 10)
                    self.extra.publish(String(data="open"))
                else:
                    self.destroy_publisher(self.extra)
        """
    )
    extra = harness.subscribe(String, "/extra")
    harness.start(file)
    assert harness.node.count_publishers("/extra") == 0
    harness.publish("/orders", String(data="open"))
    assert harness.node.count_publishers("/extra") == 1
    assert texts(extra) == ["open"]
    harness.publish("/orders", String(data="close"))
    assert harness.node.count_publishers("/extra") == 0


def test_timers_keep_the_worlds_time(harness: GraphHarness, student: Student) -> None:
    file = student(
        """
        import time
        from rclpy.node import Node
        from std_msgs.msg import String

        class Clock(Node):
            def __init__(self):
                super().__init__("clock")
                self.out = self.create_publisher(String, "ticks", 10)
                self.create_timer(0.25, self.on_timer)

            def on_timer(self):
                now = self.get_clock().now().nanoseconds
                assert now == time.time_ns()
                self.out.publish(String(data=str(now // 1_000_000)))
        """
    )
    ticks = harness.subscribe(String, "/ticks")
    process = harness.start(file)
    exchanges = 0
    for _ in range(10):
        harness.graph.advance(harness.graph.now_ns + TICK_NS)
        exchanges += process.exchange()
        harness.run_until_idle()
    assert texts(ticks) == ["250", "500", "750", "1000"]
    assert exchanges == 4, "asked although nothing was due"


def test_files_get_a_date_of_today(harness: GraphHarness, student: Student) -> None:
    """A trained agent is saved as a zip archive, which has no dates before 1980; see kit/host/child/node_program.py."""
    file = student(
        """
        import io, time, zipfile
        from datetime import datetime
        from rclpy.node import Node
        from std_msgs.msg import String

        class Saver(Node):
            def __init__(self):
                super().__init__("saver")
                self.out = self.create_publisher(String, "saved", 10)
                self.create_timer(0.1, self.save)

            def save(self):
                before = datetime.now()
                archive = zipfile.ZipFile(io.BytesIO(), "w")
                archive.writestr("data", "weights")
                with archive.open("policy.pth", "w") as file:
                    file.write(b"weights")
                written = datetime(*archive.getinfo("data").date_time)
                near = abs((written - before).total_seconds()) < 3600
                same_day = time.ctime(time.time())[:10] == time.asctime(time.localtime(time.time()))[:10]
                old = time.gmtime(1e9)[:3] == (2001, 9, 9) and time.gmtime()[0] > 2001
                self.out.publish(String(data=f"{near} {same_day} {old} {time.time():.1f}"))
        """
    )
    saved = harness.subscribe(String, "/saved")
    process = harness.start(file)
    harness.tick(2)
    assert process.failure is None
    assert texts(saved) == ["True True True 0.1", "True True True 0.2"]


LOOPS = {
    "sleep": "while rclpy.ok():\n    out.publish(String(data='x'))\n    time.sleep(0.2)",
    "rate": "rate = node.create_rate(5)\nthreading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()\n"
    "while rclpy.ok():\n    out.publish(String(data='x'))\n    rate.sleep()",
    "spin_once": "while rclpy.ok():\n    out.publish(String(data='x'))\n    rclpy.spin_once(node, timeout_sec=0.2)",
    "clock": "while rclpy.ok():\n    out.publish(String(data='x'))\n    node.get_clock().sleep_for(Duration(seconds=0.2))",
}  # fmt: skip


@pytest.mark.parametrize("loop", LOOPS)
def test_programs_with_a_loop_of_their_own(harness: GraphHarness, student: Student, loop: str) -> None:
    head = (
        "import time, threading, rclpy\nfrom rclpy.duration import Duration\nfrom std_msgs.msg import String\n"
        "rclpy.init()\nnode = rclpy.create_node('looper')\nout = node.create_publisher(String, 'beat', 10)\n"
    )
    beat = harness.subscribe(String, "/beat")
    process = harness.start(student(head + LOOPS[loop]))
    harness.tick(10)
    assert process.failure is None
    assert len(beat) == 6


def test_a_program_that_never_waits_does_not_stop_the_time(harness: GraphHarness, student: Student) -> None:
    loop = "\nrclpy.init()\necho = Echo()\nwhile rclpy.ok():\n    rclpy.spin_once(echo, timeout_sec=0)\n"
    answers = harness.subscribe(String, "/answers")
    process = harness.start(student(ECHO + loop))
    for text in "abc":
        harness.publish("/questions", String(data=text))
        harness.tick()
    assert texts(answers) == ["A", "B", "C"]
    assert process.failure is None


def test_services_both_ways(harness: GraphHarness, student: Student) -> None:
    file = student(
        """
        from rclpy.callback_groups import ReentrantCallbackGroup
        from rclpy.node import Node
        from std_srvs.srv import SetBool, Trigger

        class Servant(Node):
            def __init__(self):
                super().__init__("servant")
                self.create_service(Trigger, "/student", self.on_call)
                self.ours = self.create_client(SetBool, "/ours", callback_group=ReentrantCallbackGroup())
                assert self.ours.wait_for_service(1.0) and not self.create_client(Trigger, "/no").service_is_ready()

            async def on_call(self, request, response):
                answer = await self.ours.call_async(SetBool.Request(data=True))
                response.success, response.message = answer.success, answer.message + "!"
                return response
        """
    )

    def ours(request: Any, response: Any) -> Any:
        response.success, response.message = request.data, "said ours"
        return response

    harness.node.create_service(SetBool, "/ours", ours)
    harness.start(file)
    client = harness.node.create_client(Trigger, "/student")
    assert client.service_is_ready()
    future = client.call_async(Trigger.Request())
    harness.run_until_idle()
    assert future.result() == Trigger.Response(success=True, message="said ours!")


def test_a_blocking_call_in_main(harness: GraphHarness, student: Student) -> None:
    file = student(
        """
        import rclpy
        from std_msgs.msg import String
        from std_srvs.srv import Trigger

        def main():
            rclpy.init()
            node = rclpy.create_node("asker")
            client = node.create_client(Trigger, "/ours")
            while not client.wait_for_service(timeout_sec=0.5):
                node.get_logger().info("waiting for /ours")
            future = client.call_async(Trigger.Request())
            rclpy.spin_until_future_complete(node, future)
            node.create_publisher(String, "answers", 10).publish(String(data=future.result().message))
        """
    )
    answers = harness.subscribe(String, "/answers")
    process = harness.start(file)
    harness.tick(11)

    def ours(request: Any, response: Any) -> Any:
        response.message = "here"
        return response

    harness.node.create_service(Trigger, "/ours", ours)
    harness.tick()
    assert texts(answers) == ["here"]
    assert process.has_ended
    assert not process.is_running
    assert process.failure is None
    assert sum("waiting for /ours" in line.text for line in process.take_output().lines) == 2


def test_arguments_reach_the_nodes(harness: GraphHarness, student: Student) -> None:
    source = ECHO.replace("self.back =", "self.declare_parameter('suffix', '')\n        self.back =").replace(
        "message.data.upper()", "message.data + self.get_parameter('suffix').value"
    )
    answers = harness.subscribe(String, "/elsewhere")
    arguments = ["--ros-args", "-p", "suffix:=?!", "-r", "answers:=elsewhere", "-r", "__node:=renamed"]
    harness.start(student(source + MAIN + GUARD), args=arguments)
    assert "renamed" in harness.node.get_node_names()
    harness.publish("/questions", String(data="why"))
    assert texts(answers) == ["why?!"]


def test_scans_arrive_to_the_bit_and_nan_with_them(harness: GraphHarness, student: Student) -> None:
    file = student(
        """
        import math
        from rclpy.node import Node
        from sensor_msgs.msg import LaserScan

        class ProxyNodes(Node):
            def __init__(self):
                super().__init__("mirror")
                self.out = self.create_publisher(LaserScan, "back", 10)
                self.create_subscription(LaserScan, "scan", self.out.publish, 10)
        """
    )
    back = harness.subscribe(LaserScan, "/back")
    harness.start(file)
    scan = LaserScan(angle_min=-math.pi, ranges=array("f", [0.1, math.nan, math.inf, 1e-30, 3.0]))
    scan.header.stamp.sec = 12
    harness.publish("/scan", scan)
    (copy,) = back
    assert copy.ranges.tobytes() == scan.ranges.tobytes()
    assert (copy.header, copy.angle_min) == (scan.header, scan.angle_min)


def test_what_is_not_finite_fails_at_the_students_line(harness: GraphHarness, student: Student) -> None:
    file = student(
        """
        from geometry_msgs.msg import Twist
        from rclpy.node import Node
        from std_msgs.msg import String

        class Wild(Node):
            def __init__(self):
                super().__init__("wild")
                self.out = self.create_publisher(Twist, "cmd_vel", 10)
                self.create_subscription(String, "go", self.on_go, 10)

            def on_go(self, message):
                command = Twist()
                command.angular.z = float(message.data)
                self.out.publish(command)
        """
    )
    commands = harness.subscribe(Twist, "/cmd_vel")
    process = harness.start(file)
    harness.publish("/go", String(data="0.5"))
    assert commands[0].angular.z == 0.5
    harness.publish("/go", String(data="nan"))
    assert len(commands) == 1
    assert process.failure is not None
    assert (process.failure.kind, process.failure.line) == (FailureKind.EXCEPTION, 15)
    assert "angular.z of the Twist for /cmd_vel is not a finite number" in process.failure.message


def test_messages_among_a_processs_own_nodes_arrive_once(harness: GraphHarness, student: Student) -> None:
    file = student(
        """
        import rclpy
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.node import Node
        from std_msgs.msg import String

        class Talker(Node):
            def __init__(self):
                super().__init__("talker")
                self.out = self.create_publisher(String, "chat", 10)
                self.create_subscription(String, "questions", lambda m: self.out.publish(m), 10)

        class Counter(Node):
            def __init__(self):
                super().__init__("counter")
                self.count = 0
                self.out = self.create_publisher(String, "counts", 10)
                self.create_subscription(String, "chat", self.on_chat, 10)

            def on_chat(self, message):
                self.count += 1
                self.out.publish(String(data=str(self.count)))

        def main():
            rclpy.init()
            executor = SingleThreadedExecutor()
            for node in (Talker(), Counter()):
                executor.add_node(node)
            executor.spin()
        """
    )
    chat, counts = harness.subscribe(String, "/chat"), harness.subscribe(String, "/counts")
    harness.start(file)
    harness.publish("/questions", String(data="a"))
    harness.publish("/questions", String(data="b"))
    assert (texts(chat), texts(counts)) == (["a", "b"], ["1", "2"])


def test_a_late_subscription_gets_what_was_kept(harness: GraphHarness, student: Student) -> None:
    lasting = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    harness.node.create_publisher(String, "/map", lasting).publish(String(data="the map"))
    answers = harness.subscribe(String, "/answers")
    source = ECHO.replace(
        '"questions", self.on_question, 10', '"map", self.on_question, QoSProfile(depth=1, durability=1)'
    )
    harness.start(
        student(source.replace("from rclpy.node", "from rclpy.qos import QoSProfile\nfrom rclpy.node"))
    )
    assert texts(answers) == ["THE MAP"]


def test_quality_of_service_that_does_not_fit_is_told(harness: GraphHarness, student: Student) -> None:
    harness.node.create_publisher(String, "/questions", qos_profile_sensor_data)
    process = harness.start(student(ECHO))
    assert any("RELIABILITY" in line.text for line in process.take_output().lines)


def test_watchers_see_what_nobody_subscribes(harness: GraphHarness, student: Student) -> None:
    seen: list[tuple[str, str]] = []
    harness.graph.add_message_listener(
        lambda now, node, topic, message: seen.append((node.get_name(), topic))
    )
    harness.start(student(ECHO))
    harness.publish("/questions", String(data="x"))
    assert seen.count(("echo", "/answers")) == 1


def test_a_reset_forgets_what_is_on_its_way(harness: GraphHarness, student: Student) -> None:
    answers = harness.subscribe(String, "/answers")
    process = harness.start(student(ECHO))
    publisher = harness.node.create_publisher(String, "/questions", 10)
    harness.run_until_idle()
    publisher.publish(String(data="lost"))
    harness.graph.discard_messages()
    harness.run_until_idle()
    assert answers == []
    harness.publish("/questions", String(data="kept"))
    assert texts(answers) == ["KEPT"]
    assert process.failure is None


def test_time_that_jumps_back(harness: GraphHarness, student: Student) -> None:
    file = student(
        """
        from rclpy.node import Node
        from std_msgs.msg import String

        class Clock(Node):
            def __init__(self):
                super().__init__("clock")
                self.out = self.create_publisher(String, "ticks", 10)
                self.create_timer(1.0, lambda: self.out.publish(String()))
        """
    )
    ticks = harness.subscribe(String, "/ticks")
    harness.start(file)
    harness.tick(25)
    assert len(ticks) == 2
    harness.graph.advance(0)
    harness.run_until_idle()
    harness.tick(9)
    assert len(ticks) == 2
    harness.tick(2)
    assert len(ticks) == 3


def test_a_failing_callback_ends_the_process_only(harness: GraphHarness, student: Student) -> None:
    file = student(ECHO.replace("message.data.upper()", "message.data + 1"))
    process = harness.start(file)
    other = harness.start(student(ECHO.replace('"echo"', '"other"').replace("answers", "others"), "other.py"))
    others = harness.subscribe(String, "/others")
    harness.publish("/questions", String(data="x"))
    assert process.failure is not None
    assert (process.failure.kind, process.failure.file, process.failure.line) == (
        FailureKind.EXCEPTION,
        "work.py",
        13,
    )
    assert "TypeError" in process.failure.message
    assert "(in on_question)" in process.failure.message
    assert not process.is_running
    assert "echo" not in harness.node.get_node_names()
    harness.publish("/questions", String(data="y"))
    assert texts(others) == ["X", "Y"]
    assert other.failure is None
    assert not process.exchange()


@pytest.mark.parametrize(
    ("change", "kind", "line", "words"),
    [
        ("while True: pass", FailureKind.TIMEOUT, 13, "on_question() did not return within 0.5 s"),
        ("import sys; sys.exit(4)", FailureKind.EXIT, 13, "status 4"),
        ("exit('no scan')", FailureKind.EXIT, 13, "no scan"),
        ("import os; os._exit(1)", FailureKind.EXIT, None, "os._exit(1)"),
        ("x = bytearray(10**12)", FailureKind.MEMORY, 13, "600 MiB"),
        ("self.back.publish('text')", FailureKind.EXCEPTION, 13, "Expected"),
        ("String(data=3)", FailureKind.EXCEPTION, 13, "must be of type 'str'"),
        ("self.nothing", FailureKind.EXCEPTION, 13, "no attribute 'nothing'"),
    ],
)
def test_every_failure_of_a_node(
    harness: GraphHarness, student: Student, change: str, kind: FailureKind, line: int | None, words: str
) -> None:
    source = ECHO.replace("self.back.publish(String(data=message.data.upper()))", change)
    process = harness.start(student(source), limits=dataclasses.replace(QUICK, reply_s=0.5))
    harness.publish("/questions", String(data="x"))
    assert process.failure is not None
    assert (process.failure.kind, process.failure.line) == (kind, line)
    assert words in process.failure.message


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("x = 1", "no main() to call"),
        ("def main(): pass", "without creating a node"),
        ("from rclpy.node import Node\nclass A(Node): ...\nclass B(Node): ...", "A and B"),
        (
            "from rclpy.node import Node\nclass A(Node):\n  def __init__(self): super().__init__('no-good!')",
            "no-good!",
        ),
        ("from rclpy.node import Nod", "Did you mean 'Node'?"),
        ("from geometry_msgs.msg import Twst", "Did you mean 'Twist'?"),
        ("from launch.actions import Zzzz", "The kit's launch.actions has no Zzzz"),
        ("import geometry_msg", "Did you mean 'geometry_msgs'?"),
        ("import nav2_msgs", "nav2_msgs is not in the kit"),
        ("import vision_msgs.msg", "source folder of vision_msgs"),
        ("import serial", "pip install pyserial"),
        ("from turtle_msgs.msg import Shell", "No module named 'turtle_msgs'"),
        ("import sys\nif __name__ == '__main__': sys.exit(2)", "status 2"),
        ("exit('no map')", "no map"),
        ("quit()", "without creating a node"),
    ],
)
def test_a_file_that_cannot_be_run(student: Student, source: str, words: str) -> None:
    graph = Graph()
    with pytest.raises(StudentCodeError) as caught:
        NodeProcess.start(graph, student(source), limits=QUICK)
    assert words in str(caught.value)
    assert caught.value.failure.file == "work.py"
    assert graph.nodes == ()


def test_a_base_class_is_not_a_second_node(harness: GraphHarness, student: Student) -> None:
    harness.start(
        student(ECHO + "\nclass Louder(Echo):\n    def __init__(self):\n        super().__init__()\n")
    )
    assert "echo" in harness.node.get_node_names()


def test_sys_exit_of_main_at_the_end_is_an_end(harness: GraphHarness, student: Student) -> None:
    source = "import sys, rclpy\ndef main():\n    rclpy.init()\n    rclpy.create_node('brief')\n    rclpy.shutdown()\n"
    process = harness.start(student(source + "if __name__ == '__main__':\n    sys.exit(main())\n"))
    assert process.has_ended
    assert process.failure is None
    assert harness.node.get_node_names() == ["checker"]


EXITING = """
import sys, threading, rclpy
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("brief")

def on_go(message):
    IN_CALLBACK

def main():
    node.create_subscription(String, "go", on_go, 10)
    IN_MAIN
    executor = EXECUTOR()
    executor.add_node(node)
    executor.spin()

AT_IMPORT
main()
"""


def exiting(student: Student, place: str, statement: str, executor: str = "SingleThreadedExecutor") -> Path:
    """Returns a program that executes a statement ``IN_CALLBACK`` of a message, ``IN_MAIN`` or ``AT_IMPORT``."""
    source = EXITING.replace(place, statement).replace("EXECUTOR()", f"{executor}()")
    return student(re.sub("IN_CALLBACK|IN_MAIN|AT_IMPORT", "pass", source))


@pytest.mark.parametrize("place", ["AT_IMPORT", "IN_MAIN", "IN_CALLBACK"])
@pytest.mark.parametrize("statement", ["exit()", "quit(0)", "raise SystemExit"])
def test_a_program_that_exits_has_ended(
    harness: GraphHarness, student: Student, place: str, statement: str
) -> None:
    process = harness.start(exiting(student, place, statement))
    harness.publish("/go", String())
    assert process.has_ended
    assert process.failure is None
    assert harness.node.get_node_names() == ["checker"]


@pytest.mark.parametrize("place", ["AT_IMPORT", "IN_MAIN", "IN_CALLBACK"])
@pytest.mark.parametrize(
    ("statement", "status", "words"),
    [("exit(3)", 3, "status 3"), ("quit(-1)", 255, "status 255"), ("exit('no map')", 1, "no map")],
)
def test_a_program_that_exits_with_a_status_has_failed(
    harness: GraphHarness, student: Student, place: str, statement: str, status: int, words: str
) -> None:
    file = exiting(student, place, statement)
    line = 1 + file.read_text().partition(statement)[0].count("\n")
    if place == "IN_CALLBACK":
        process = harness.start(file)
        harness.publish("/go", String())
        failure = process.failure
    else:
        with pytest.raises(StudentCodeError) as caught:
            harness.start(file)
        failure = caught.value.failure
    assert failure is not None
    assert (failure.kind, failure.file, failure.line, failure.status) == (
        FailureKind.EXIT,
        "work.py",
        line,
        status,
    )
    assert words in failure.message


def test_an_exit_in_one_of_many_threads_ends_the_program(harness: GraphHarness, student: Student) -> None:
    process = harness.start(exiting(student, "IN_CALLBACK", "exit()", "MultiThreadedExecutor"))
    harness.publish("/go", String())
    harness.tick(3)
    assert process.has_ended
    assert process.failure is None


def test_a_thread_that_exits_ends_itself_alone(harness: GraphHarness, student: Student) -> None:
    thread = "thread = threading.Thread(target=exit, args=(3,)); thread.start(); thread.join()"
    process = harness.start(exiting(student, "IN_MAIN", thread))
    harness.tick()
    assert process.is_running
    assert process.failure is None


def test_what_python_has_of_the_module_site(harness: GraphHarness, student: Student) -> None:
    process = harness.start(
        exiting(
            student, "IN_MAIN", "print(exit, copyright, credits, license, help, sep=chr(10)); help(String)"
        )
    )
    harness.tick()
    assert process.failure is None
    printed = "\n".join(line.text for line in process.take_output().lines)
    assert "Copyright" in printed
    assert "class String" in printed


def test_a_thread_that_fails_is_told(harness: GraphHarness, student: Student) -> None:
    file = student(
        """
        import threading, time, rclpy
        from std_msgs.msg import String

        def main():
            rclpy.init()
            node = rclpy.create_node("threaded")
            node.create_subscription(String, "go", on_go, 10)
            threading.Thread(target=rclpy.spin, args=(node,)).start()

        def on_go(message):
            raise ValueError(message.data)
        """
    )
    process = harness.start(file)
    harness.tick()
    harness.publish("/go", String(data="from a thread"))
    harness.tick(3)
    assert process.failure is not None
    assert (process.failure.kind, process.failure.line) == (FailureKind.EXCEPTION, 12)
    assert "from a thread" in process.failure.message


def test_a_transform_is_waited_for_in_a_callback_too(harness: GraphHarness, student: Student) -> None:
    """As tf2_ros does: in vain where one thread spins, and its time-out passes."""
    file = student(
        """
        import rclpy, tf2_ros
        from rclpy.duration import Duration
        from rclpy.time import Time
        from std_msgs.msg import String

        def look():
            began = node.get_clock().now()
            try:
                buffer.lookup_transform("a", "b", Time(), timeout=Duration(seconds=0.2))
            except tf2_ros.LookupException:
                waited = (node.get_clock().now() - began).nanoseconds / 1e9
                publisher.publish(String(data=f"{waited:.1f}"))

        rclpy.init()
        node = rclpy.create_node("late")
        publisher = node.create_publisher(String, "waited", 10)
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer, node)
        node.create_timer(0.1, look)
        rclpy.spin(node)
        """
    )
    waited = harness.subscribe(String, "/waited")
    harness.start(file)
    harness.tick(60)
    assert texts(waited)
    assert set(texts(waited)) == {"0.2"}


def test_ticks_pass_beside_a_thread_that_computes_without_end(
    harness: GraphHarness, student: Student
) -> None:
    """As a camera's thread does. Each time a tick waits for the interpreter, that thread may keep it for a switch interval."""
    file = student(
        """
        import sys, threading, rclpy
        from std_msgs.msg import String

        def compute():
            while True:
                sum(range(1000))

        def main():
            rclpy.init()
            node = rclpy.create_node("camera")
            threading.Thread(target=compute, daemon=True).start()
            found = node.create_publisher(String, "found", 10)
            node.create_timer(0.1, lambda: found.publish(String(data=str(sys.getswitchinterval() <= 0.001))))
            rclpy.spin(node)
        """
    )
    found = harness.subscribe(String, "/found")
    harness.start(file)
    harness.tick(30)
    assert texts(found)
    assert set(texts(found)) == {"True"}


@pytest.mark.long
@pytest.mark.parametrize("end", ["raise ValueError('late')", "return"])
def test_an_end_while_another_thread_waits_for_the_kit(
    harness: GraphHarness, student: Student, end: str
) -> None:
    file = student(
        f"""
        import threading, time, rclpy

        def main():
            rclpy.init()
            node = rclpy.create_node("threaded")
            threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
            until = time.monotonic() + 0.3
            while time.monotonic() < until: pass
            {end}
        """
    )
    process = harness.start(file)
    deadline = time.monotonic() + 10
    while process.is_running and time.monotonic() < deadline:
        harness.tick()
        time.sleep(0.02)
    assert not process.is_running
    assert process.has_ended == (end == "return")
    if process.failure is not None:
        assert (process.failure.kind, process.failure.line) == (FailureKind.EXCEPTION, 10)


def test_a_program_may_close_what_it_prints_to(harness: GraphHarness, student: Student) -> None:
    answers = harness.subscribe(String, "/answers")
    harness.start(
        student(ECHO.replace("import rclpy", "import sys, rclpy\nsys.stdout.close()\nsys.stderr = None"))
    )
    harness.publish("/questions", String(data="still there"))
    assert texts(answers) == ["STILL THERE"]


def test_a_program_that_closed_what_it_prints_to_still_fails_with_words(
    harness: GraphHarness, student: Student
) -> None:
    source = ECHO.replace("import rclpy", "import sys, rclpy\nsys.stdout.close()\nsys.stderr.close()")
    process = harness.start(
        student(source.replace("self.back.publish(", "self.deeper(") + "    def deeper(self, x): 1 / 0\n")
    )
    harness.publish("/questions", String(data="x"))
    assert process.failure is not None
    assert process.failure.kind is FailureKind.EXCEPTION
    assert "ZeroDivisionError" in process.failure.message
    assert any("in on_question: self.deeper(" in line.text for line in process.take_output().lines)


def test_callbacks_in_threads_answer_within_the_tick(harness: GraphHarness, student: Student) -> None:
    file = student(
        """
        import threading, rclpy
        from rclpy.callback_groups import ReentrantCallbackGroup
        from rclpy.executors import MultiThreadedExecutor
        from std_msgs.msg import String

        def main():
            rclpy.init()
            node = rclpy.create_node("many")
            out = node.create_publisher(String, "answers", 10)
            group = ReentrantCallbackGroup()

            def on_question(message):
                sum(range(200_000))
                out.publish(message)

            node.create_subscription(String, "questions", on_question, 10, callback_group=group)
            executor = MultiThreadedExecutor(2)
            executor.add_node(node)
            executor.spin()
        """
    )
    answers = harness.subscribe(String, "/answers")
    process = harness.start(file)
    harness.tick()
    for text in "abcde":
        harness.publish("/questions", String(data=text))
    assert texts(answers) == list("abcde")
    assert process.failure is None
    assert process.wake_ns is None, "idle threads of a pool are not waited for, and need no ticks"


def test_callbacks_without_a_free_thread_are_not_waited_for(harness: GraphHarness, student: Student) -> None:
    """More callbacks than threads, which all wait for simulated time: the next tick is that of the first of them."""
    file = student(
        """
        import time, rclpy
        from rclpy.callback_groups import ReentrantCallbackGroup
        from rclpy.executors import MultiThreadedExecutor
        from std_msgs.msg import String

        def main():
            rclpy.init()
            node = rclpy.create_node("many")
            out = node.create_publisher(String, "answers", 10)
            group = ReentrantCallbackGroup()

            def on_question(message):
                time.sleep(0.5)
                out.publish(message)

            node.create_subscription(String, "questions", on_question, 10, callback_group=group)
            executor = MultiThreadedExecutor(2)
            executor.add_node(node)
            executor.spin()
        """
    )
    answers = harness.subscribe(String, "/answers")
    process = harness.start(file)
    harness.tick()
    begin_ns = harness.graph.now_ns
    for text in "abcde":
        harness.publish("/questions", String(data=text))
    for rounds in (1, 2, 3):
        assert process.failure is None
        due_ns = begin_ns + rounds * 500_000_000
        assert process.wake_ns == due_ns
        while process.wake_ns == due_ns:
            harness.tick()
        assert len(answers) == min(2 * rounds, 5)
    assert sorted(texts(answers)) == list("abcde")
    assert process.wake_ns is None


def test_a_thread_that_slept_finds_what_others_do_at_that_instant_done(
    harness: GraphHarness, student: Student
) -> None:
    """However long the other threads take: both wake up in the same tick."""
    file = student(
        """
        import threading, time, rclpy
        from std_msgs.msg import String

        def main():
            rclpy.init()
            node = rclpy.create_node("sleeper")
            out = node.create_publisher(String, "answers", 10)
            done = []

            def on_timer():
                sum(range(300_000))
                done.append(node.get_clock().now())

            node.create_timer(0.1, on_timer)
            threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
            rate = node.create_rate(10)
            for number in range(1, 7):
                rate.sleep() if number < 4 else time.sleep(0.1)
                out.publish(String(data=f"{number} {len(done)}"))
            time.sleep(1.0)
        """
    )
    answers = harness.subscribe(String, "/answers")
    harness.start(file)
    for _ in range(80):
        harness.tick()
    assert texts(answers) == [f"{number} {number}" for number in range(1, 7)]


def test_a_thread_that_never_waits_here_is_tolerated(harness: GraphHarness, student: Student) -> None:
    """As in the dissertation: one thread learns and blocks until the next scan, another one spins."""
    file = student(
        """
        import threading, rclpy
        from rclpy.node import Node
        from std_msgs.msg import String

        class Env(Node):
            def __init__(self):
                super().__init__("env")
                self.arrived = threading.Event()
                self.out = self.create_publisher(String, "actions", 10)
                self.create_subscription(String, "questions", lambda message: self.arrived.set(), 10)

            def learn(self):
                step = 0
                while True:
                    self.arrived.wait()
                    self.arrived.clear()
                    step += 1
                    self.out.publish(String(data=str(step)))

        def main():
            rclpy.init()
            env = Env()
            threading.Thread(target=env.learn, daemon=True).start()
            rclpy.spin(env)
        """
    )
    actions = harness.subscribe(String, "/actions")
    process = harness.start(file)

    def question() -> list[String]:
        harness.publish("/questions", String())
        harness.tick()
        return actions

    # The thread that learns answers when the machine gives it the time to.
    wait_until(lambda: question() or process.failure, "an answer")
    assert process.failure is None
    assert texts(actions) == [str(i + 1) for i in range(len(actions))]


WALK = """
import math, random
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node

class Walk(Node):
    def __init__(self):
        super().__init__("walk")
        self.out = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Odometry, "odom", self.on_odom, 10)
        self.names = {"left", "right", "up", "down"}

    def on_odom(self, odom):
        twist = Twist()
        twist.linear.x = random.gauss(0, 1) + math.sin(odom.pose.pose.position.x)
        twist.angular.z = random.uniform(-1, 1) * len(next(iter(self.names)))
        self.out.publish(twist)
"""


@pytest.mark.long
def test_the_same_run_to_the_bit(student: Student) -> None:
    def run(seed: int) -> list[tuple[str, str]]:
        harness = GraphHarness()
        commands = harness.subscribe(Twist, "/cmd_vel")
        process = harness.start(student(WALK), seed=seed)
        try:
            odom, x = Odometry(), 0.0
            for _ in range(200):
                odom.pose.pose.position.x = x
                harness.tick()
                harness.publish("/odom", odom)
                x += commands[-1].linear.x * 0.1
        finally:
            process.close()
        return [(command.linear.x.hex(), command.angular.z.hex()) for command in commands]

    first = run(3)
    assert len(first) == 200
    assert run(3) == first
    assert run(4) != first


def test_logs_and_prints_are_kept_apart_and_in_order(harness: GraphHarness, student: Student) -> None:
    process = harness.start(
        student(ECHO.replace("self.back.publish", "self.get_logger().warning('received'); print"))
    )
    harness.publish("/questions", String(data="x"))
    lines = process.take_output().lines
    assert any(
        line.stream == "err" and "[WARN]" in line.text and "[echo]: received" in line.text for line in lines
    )
    assert any(line.stream == "out" and "data='X'" in line.text for line in lines)


@pytest.mark.usefixtures("cold_start")
def test_a_process_is_light(harness: GraphHarness, student: Student) -> None:
    heavy = ("numpy", "numba", "pymunk", "PIL", "textual", "click", "networkx", "torch")
    loaded = f"[name for name in {heavy} if name in sys.modules]"
    source = ECHO.replace("message.data.upper()", f"str({loaded} + [sys.flags.no_site])")
    answers = harness.subscribe(String, "/answers")
    harness.start(student("import sys" + source))
    harness.publish("/questions", String())
    assert texts(answers) == ["[1]"]  # the module site is imported for its names, but was not run


@pytest.mark.usefixtures("cold_start")
@pytest.mark.long
def test_several_processes_start_side_by_side(student: Student) -> None:
    graph = Graph()
    processes = [
        NodeProcess(graph, student(ECHO.replace('"echo"', f'"echo{i}"'), f"echo{i}.py"), limits=QUICK)
        for i in range(3)
    ]
    try:
        waiting = list(processes)
        while waiting:
            waiting = [process for process in waiting if not process.is_started()]
        for process in processes:
            process.join()
        assert [node.get_name() for node in graph.nodes] == ["echo0", "echo1", "echo2"]
    finally:
        for process in processes:
            process.close()
    assert graph.nodes == ()


@pytest.mark.long
def test_time_spent_on_a_programs_messages_counts_as_the_programs(
    harness: GraphHarness, student: Student
) -> None:
    limits = dataclasses.replace(QUICK, total_s=60.0)
    process = harness.start(student(ECHO + MAIN), limits=limits)
    harness.publish("questions", String(data="a"))
    assert process.failure is None
    process._process.charge(60.0)
    harness.publish("questions", String(data="b"))
    assert process.failure is not None
    assert process.failure.kind is FailureKind.TIMEOUT


def test_messages_of_one_tick_are_limited_and_those_of_many_are_not(
    harness: GraphHarness, student: Student
) -> None:
    process = harness.start(student(ECHO + MAIN), limits=dataclasses.replace(QUICK, messages=6))
    for _ in range(4):
        harness.publish("questions", String(data="a"))
        harness.tick()
        harness.publish("questions", String(data="b"))
    assert process.failure is None
    for _ in range(8):
        harness.publish("questions", String(data="c"))
    assert process.failure is not None
    assert process.failure.kind is FailureKind.FLOOD
    assert "more than 6 messages" in str(process.failure)


def test_a_program_is_loaded_before_it_is_in_the_graph(harness: GraphHarness, student: Student) -> None:
    file = student(ECHO + MAIN.replace("rclpy.init", "print('main'); rclpy.init"))
    process = NodeProcess(harness.graph, file, limits=QUICK, loads_first=True)
    harness.processes.append(process)
    process.wait_until_started()
    answers = harness.subscribe(String, "answers")
    process.enter_graph()
    process.join()
    harness.publish("questions", String(data="who"))
    harness.run_until_idle()
    assert [each.data for each in answers] == ["WHO"]


def test_a_forged_start_with_events_is_refused(harness: GraphHarness, student: Student) -> None:
    forged = """
import json, os, struct
content = json.dumps(["reply", 0, None, [["node", 1, "x", "/", []]]]).encode()
for descriptor in range(3, 20):
    try:
        os.write(descriptor, struct.pack(">I", len(content)) + content)
    except OSError:
        pass
import threading
threading.Event().wait()
"""
    process = NodeProcess(harness.graph, student(forged), limits=QUICK, loads_first=True)
    harness.processes.append(process)

    def start() -> None:
        process.wait_until_started()
        process.enter_graph()

    with pytest.raises(StudentCodeError) as caught:
        start()
    assert caught.value.failure.kind is FailureKind.PROTOCOL
