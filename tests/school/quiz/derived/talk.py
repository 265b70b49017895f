"""What nodes say to one another, found out in a graph."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from kit.msg.fields import FieldError
from kit.msg.geometry_msgs import Twist
from kit.msg.std_msgs import Int32
from kit.msg.std_srvs import Trigger
from kit.ros.exceptions import (
    InvalidParameterTypeException,
    ParameterNotDeclaredException,
    WouldDeadlock,
)
from kit.ros.execution.context import Context, context_of
from kit.ros.execution.executors import SingleThreadedExecutor
from kit.ros.graph.graph import Graph
from kit.ros.launch.actions import DeclareLaunchArgument, LogInfo
from kit.ros.launch.entity import LaunchDescription
from kit.ros.launch.processes import ExecuteProcess
from kit.ros.launch.service import LaunchService
from kit.ros.launch.substitutions import LaunchConfiguration
from kit.ros.log import LogRecord
from kit.ros.node.node import Node, create_graph_node
from kit.ros.node.qos import QoSProfile, ReliabilityPolicy
from kit.ros.parameters.parameter import Parameter
from kit.run.scenario import scenario_on_map
from kit.run.session import Session
from kit.school.quiz.items import QuizItem
from kit.world.catalogue import find_map
from tests.school.quiz.derived.finding import Derivation, Finding


def _graph(lines: list[LogRecord] | None = None) -> Graph:
    return Graph(log_sink=([] if lines is None else lines).append)


def _node(graph: Graph, *arguments: str, **options: Any) -> Node:
    return Node("node", context=context_of(graph), cli_args=["--ros-args", *arguments], **options)


# Topics


def drive_listens(item: QuizItem, folder: Path) -> Finding:
    """By what the kit's own drive is told its speed."""
    with Session(scenario_on_map(find_map("simple"))) as session:
        directory = session.graph.directory
        found = {
            "topic": any(True for _ in directory.subscriptions("/cmd_vel")),
            "service": "/cmd_vel" in directory.services,
            "node": any(handle.name == "cmd_vel" for handle in directory.nodes),
        }
    (truth,) = [kind for kind, there in found.items() if there]
    return Finding(
        truth,
        {
            "A service that the motor's node serves": "service",
            "A topic that the motor's node subscribes": "topic",
            "A second node that passes them on": "node",
        },
    )


def three_publishers(item: QuizItem, folder: Path) -> Finding:
    graph, heard = _graph(), []
    create_graph_node(graph, "drive").create_subscription(
        Int32, "/cmd_vel", lambda message: heard.append(message.data), 10
    )
    publishers = [create_graph_node(graph, f"n{i}").create_publisher(Int32, "/cmd_vel", 10) for i in range(3)]
    for _ in range(2):
        for number, publisher in enumerate(publishers):
            publisher.publish(Int32(data=number))
    graph.run_due()
    return Finding(
        tuple(heard),
        {
            "Every message of all three": (0, 1, 2, 0, 1, 2),
            "Only the messages of the first one": (0, 0),
            "Nothing, until two of them leave": (),
        },
    )


def nobody_spins(item: QuizItem, folder: Path) -> Finding:
    """On the system's time, as a program that stands alone."""
    graph, heard = Graph(None, log_sink=[].append), []
    create_graph_node(graph, "deaf").create_subscription(Int32, "x", heard.append, 100)
    publisher = create_graph_node(graph, "talker").create_publisher(Int32, "x", 100)
    for number in range(60):
        publisher.publish(Int32(data=number))
    return Finding(
        len(heard),
        {
            "Sixty times, once for each message": 60,
            "Once, with the newest message": 1,
            "Not once in that minute": 0,
        },
    )


def queue_depth(item: QuizItem, folder: Path) -> Finding:
    graph, heard = _graph(), []
    create_graph_node(graph, "busy").create_subscription(
        Int32, "x", lambda message: heard.append(message.data), 5
    )
    publisher = create_graph_node(graph, "talker").create_publisher(Int32, "x", 10)
    for number in range(1, 9):
        publisher.publish(Int32(data=number))
    graph.run_due()
    means = {option.text: tuple(map(int, option.text.split(", "))) for option in item.options}
    return Finding(tuple(heard), means)


def qos_mismatch(item: QuizItem, folder: Path) -> Finding:
    lines: list[LogRecord] = []
    graph, heard = _graph(lines), []
    offered = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
    publisher = create_graph_node(graph, "talker").create_publisher(Int32, "x", offered)
    asked = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)
    create_graph_node(graph, "listener").create_subscription(Int32, "x", heard.append, asked)
    for _ in range(5):
        publisher.publish(Int32())
    graph.run_due()
    warned = {line.name for line in lines if "RELIABILITY" in line.text}
    return Finding(
        (len(heard), len(warned)),
        {
            "Everything, since the subscription insists": (5, 0),
            "Most of it, and a few messages are lost": (4, 0),
            "Nothing, and both sides are warned": (0, 2),
        },
    )


def int_for_float(item: QuizItem, folder: Path) -> Finding:
    command = Twist()
    try:
        command.linear.x = 1
        found: object = command.linear.x
    except (AssertionError, FieldError):
        found = "error"
    return Finding(
        found,
        {
            "An error: the field must be a float": "error",
            "Nothing bad: it becomes 1.0": 1.0,
            "The robot stands: it becomes 0.0": 0.0,
        },
    )


def latecomer(item: QuizItem, folder: Path) -> Finding:
    graph, heard = _graph(), []
    create_graph_node(graph, "talker").create_publisher(Int32, "x", 10).publish(Int32(data=7))
    graph.run_due()
    graph.advance(1_000_000_000)
    create_graph_node(graph, "late").create_subscription(
        Int32, "x", lambda message: heard.append(message.data), 10
    )
    graph.run_due()
    return Finding(
        tuple(heard),
        {
            "That message, from the queue of ten": (7,),
            "Nothing, until the next message": (),
            "An empty message, as a sign of life": (0,),
        },
    )


# Services and parameters


def move_answers(item: QuizItem, folder: Path) -> Finding:
    """By what the kit's world is asked to move a robot, and whether it says how that went."""
    from kit.msg.flatland_msgs import MoveModel

    with Session(scenario_on_map(find_map("simple"))) as session:
        node = create_graph_node(session.graph, "asker")
        client = node.create_client(MoveModel, "/move_model")
        futures = [
            client.call_async(MoveModel.Request(name=name)) for name in (session.scenario.robot, "nobody")
        ]
        session.runner.tick()
        told = [future.result().success for future in futures]
        as_topic = any(True for _ in session.graph.directory.subscriptions("/move_model"))
    found = "service" if told == [True, False] and not as_topic else "other"
    return Finding(
        found,
        {
            "A topic that names where the robot should be": "topic",
            "A parameter that holds where the robot is": "parameter",
            "A service that moves it and says if it could": "service",
        },
    )


def call_deadlock(item: QuizItem, folder: Path) -> Finding:
    graph = Graph(None, log_sink=[].append)
    node = create_graph_node(graph, "node")
    node.create_service(Trigger, "s", lambda request, response: Trigger.Response(message="done"))
    client = node.create_client(Trigger, "s")
    answers: list[Any] = []
    node.create_timer(0.001, lambda: answers.append(client.call(Trigger.Request())))
    executor = SingleThreadedExecutor(context=context_of(graph))
    executor.add_node(node)
    try:
        executor.spin_once(timeout_sec=5)
        found = "no answer" if answers == [None] else "answer"
    except WouldDeadlock:
        found = "for ever"
    return Finding(
        found,
        {
            "It waits for ever, with no error": "for ever",
            "It goes on when the server answers": "answer",
            "It returns at once, with no answer": "no answer",
        },
    )


def nobody_serves(item: QuizItem, folder: Path) -> Finding:
    graph = _graph()
    try:
        future = (
            create_graph_node(graph, "node").create_client(Trigger, "/reset").call_async(Trigger.Request())
        )
        graph.advance(1_000_000_000)
        graph.run_due()
        found = "done" if future.done() else "not done"
    except Exception:  # noqa: BLE001 - whatever it raises is the finding
        found = "exception"
    return Finding(
        found,
        {
            "An exception from call_async": "exception",
            "A future that is done, with None": "done",
            "A future that is not done": "not done",
        },
    )


def undeclared_parameter(item: QuizItem, folder: Path) -> Finding:
    try:
        found: object = create_graph_node(_graph(), "node").get_parameter("speed").value
    except ParameterNotDeclaredException:
        found = "exception"
    return Finding(
        found,
        {
            "An exception that says it is not declared": "exception",
            "A parameter whose value is None": None,
            "A parameter whose value is 0.0": 0.0,
        },
    )


def parameter_type(item: QuizItem, folder: Path) -> Finding:
    node = create_graph_node(_graph(), "node")
    node.declare_parameter("speed", 0.5)
    try:
        (result,) = node.set_parameters([Parameter("speed", value="fast")])
        assert not result.successful or node.get_parameter("speed").value == "fast"
    except InvalidParameterTypeException:
        pass
    found = node.get_parameter("speed").value if node.has_parameter("speed") else None
    return Finding(found, {'The text "fast"': "fast", "Still 0.5": 0.5, "No longer declared": None})


# Launch files


def one_graph(item: QuizItem, folder: Path) -> Finding:
    """Two programs, each with a context of its own, as the processes of two launches have."""
    graph, heard = _graph(), []
    contexts = [Context(graph), Context(graph)]
    for context in contexts:
        context.init(args=[])
    robot, logger = (
        Node(name, context=each) for name, each in zip(("robot", "logger"), contexts, strict=True)
    )
    logger.create_subscription(Int32, "/odom", heard.append, 10)
    robot.create_publisher(Int32, "/odom", 10).publish(Int32())
    graph.run_due()
    return Finding(
        "always" if heard else "never",
        {
            "Yes: both are in one graph": "always",
            "No: each launch has its own graph": "never",
            "Only if one file includes the other": "included",
        },
    )


def _topics(node: Node, *names: str) -> frozenset[str]:
    return frozenset(node.create_publisher(Int32, name, 10).topic_name for name in names)


def remapping(item: QuizItem, folder: Path) -> Finding:
    found = _topics(_node(_graph(), "-r", "cmd_vel:=/second/cmd_vel"), "cmd_vel")
    return Finding(
        found,
        {
            "On /cmd_vel alone": frozenset({"/cmd_vel"}),
            "On /second/cmd_vel alone": frozenset({"/second/cmd_vel"}),
            "On both of them": frozenset({"/cmd_vel", "/second/cmd_vel"}),
        },
    )


def namespace(item: QuizItem, folder: Path) -> Finding:
    found = _topics(_node(_graph(), "-r", "__ns:=/left"), "scan", "/alarm")
    return Finding(found, {option.text: frozenset(option.text.split(" and ")) for option in item.options})


def _launched(*entities: Any, **arguments: str) -> list[Any]:
    service = LaunchService("/p/launch/x.launch.py", arguments, environment={})
    return service.start(LaunchDescription(list(entities)))


def launch_argument(item: QuizItem, folder: Path) -> Finding:
    shown = LogInfo(msg=LaunchConfiguration("world"))
    requests = _launched(DeclareLaunchArgument("world", default_value="maze"), shown, world="house")
    (said,) = [content[1] for kind, *content in requests if kind == "log"]
    return Finding(said, {option.text: option.text for option in item.options})


def parameter_override(item: QuizItem, folder: Path) -> Finding:
    seen: list[float] = []
    node = _node(_graph(), "-p", "speed:=0.3")
    seen.append(node.declare_parameter("speed", 0.5).value)
    seen.append(node.get_parameter("speed").value)
    return Finding(
        tuple(seen),
        {
            "0.5, since what the program sets comes last": (0.5, 0.5),
            "0.3, since the launch file was asked": (0.3, 0.3),
            "0.5, then 0.3 when it is set again": (0.5, 0.3),
        },
    )


def launch_side_by_side(item: QuizItem, folder: Path) -> Finding:
    """Both are asked for before anything has happened to either."""
    requests = _launched(ExecuteProcess(cmd=["driver"]), ExecuteProcess(cmd=["logger"]))
    started = sum(kind == "process" for kind, *_ in requests)
    return Finding(
        started,
        {
            "When the driver has ended": 1,
            "When the driver has published": "1, then 2",
            "At once, beside the driver": 2,
        },
    )


TALK: dict[str, Derivation] = {
    "drive-listens": drive_listens,
    "three-publishers": three_publishers,
    "nobody-spins": nobody_spins,
    "queue-depth": queue_depth,
    "qos-mismatch": qos_mismatch,
    "int-for-float": int_for_float,
    "latecomer": latecomer,
    "move-answers": move_answers,
    "call-deadlock": call_deadlock,
    "nobody-serves": nobody_serves,
    "undeclared-parameter": undeclared_parameter,
    "parameter-type": parameter_type,
    "one-graph": one_graph,
    "remapping": remapping,
    "namespace": namespace,
    "launch-argument": launch_argument,
    "parameter-override": parameter_override,
    "launch-side-by-side": launch_side_by_side,
}
