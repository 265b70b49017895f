"""The functions of ``rclpy`` itself: init, shutdown, spin, create_node, loggers, wait_for_message."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Sequence
from enum import IntFlag
from types import FrameType, TracebackType
from typing import Any, TypeVar

from kit.msg.message import Message
from kit.ros.execution.arguments import split_ros_arguments
from kit.ros.execution.context import Context, get_default_context
from kit.ros.execution.executors import Executor, SingleThreadedExecutor
from kit.ros.execution.task import Future
from kit.ros.log import LoggingSeverity, RcutilsLogger
from kit.ros.node.node import Node
from kit.ros.node.qos import QoSProfile
from kit.ros.node.time import S_TO_NS
from kit.ros.parameters.parameter import Parameter

M = TypeVar("M", bound=Message)


class SignalHandlerOptions(IntFlag):
    """The signals that shut the context down."""

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = 3


class InitContextManager:
    """The result of ``init``: ``with rclpy.init(): ...`` shuts down at the end."""

    def __init__(self, context: Context) -> None:
        self.context = context

    def __enter__(self) -> InitContextManager:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None
    ) -> None:
        try_shutdown(context=self.context)


def init(
    *,
    args: Sequence[str] | None = None,
    context: Context | None = None,
    domain_id: int | None = None,
    signal_handler_options: SignalHandlerOptions | None = None,
) -> InitContextManager:
    """Initialises a context, in which nodes can be created. ``args`` None means the program's command line.

    A program that stands alone also gets its signals handled: Ctrl-C raises KeyboardInterrupt as ever, SIGTERM
    makes ``spin`` raise ExternalShutdownException. Raises RuntimeError the second time, InvalidRosArguments.
    """
    context = context or get_default_context()
    context.init(args, domain_id=domain_id)
    alone = not context.graph.is_simulated
    options = signal_handler_options
    if options is None:
        options = SignalHandlerOptions.ALL if alone else SignalHandlerOptions.NO
    install_signal_handlers(context, options)
    return InitContextManager(context)


def shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """Shuts the context down: waits end, ``ok()`` is False. RuntimeError if the program has done so before."""
    (context or get_default_context(shutting_down=True)).shutdown()


def try_shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """Shuts the context down, without an error if it has been already."""
    (context or get_default_context(shutting_down=True)).try_shutdown()


def ok(*, context: Context | None = None) -> bool:
    """True between init and shutdown."""
    asked = context or get_default_context()
    if asked.ok():
        asked.graph.count_read()
    return asked.ok()


def create_node(
    node_name: str,
    *,
    context: Context | None = None,
    cli_args: list[str] | None = None,
    namespace: str | None = None,
    use_global_arguments: bool = True,
    enable_rosout: bool = True,
    start_parameter_services: bool = True,
    parameter_overrides: list[Parameter] | None = None,
    allow_undeclared_parameters: bool = False,
    automatically_declare_parameters_from_overrides: bool = False,
    enable_logger_service: bool = False,
) -> Node:
    """Makes a node."""
    return Node(
        node_name,
        context=context,
        cli_args=cli_args,
        namespace=namespace,
        use_global_arguments=use_global_arguments,
        enable_rosout=enable_rosout,
        start_parameter_services=start_parameter_services,
        parameter_overrides=parameter_overrides,
        allow_undeclared_parameters=allow_undeclared_parameters,
        automatically_declare_parameters_from_overrides=automatically_declare_parameters_from_overrides,
        enable_logger_service=enable_logger_service,
    )


def get_global_executor() -> Executor:
    """The single-threaded executor that is used where none is named."""
    return _executor_of(get_default_context())


def _executor_of(context: Context) -> Executor:
    with context.graph.lock:
        if context.global_executor is None:
            context.global_executor = SingleThreadedExecutor(context=context)
        executor: Executor = context.global_executor
        return executor


def spin(node: Node, executor: Executor | None = None) -> None:
    """Runs the node's callbacks until the context is shut down. Raises what a callback raises."""
    executor = executor or _executor_of(node.context)
    try:
        executor.add_node(node)
        executor.spin()
    finally:
        executor.remove_node(node)


def spin_once(node: Node, *, executor: Executor | None = None, timeout_sec: float | None = None) -> None:
    """Runs at most one callback. ``timeout_sec`` None or negative: waits for it; 0: does not wait."""
    executor = executor or _executor_of(node.context)
    try:
        executor.add_node(node)
        executor.spin_once(timeout_sec=timeout_sec)
    finally:
        executor.remove_node(node)


def spin_until_future_complete(
    node: Node, future: Future[Any], executor: Executor | None = None, timeout_sec: float | None = None
) -> None:
    """Runs the node's callbacks until the future is done or the time-out is reached."""
    executor = executor or _executor_of(node.context)
    try:
        executor.add_node(node)
        executor.spin_until_future_complete(future, timeout_sec)
    finally:
        executor.remove_node(node)


def get_rmw_implementation_identifier() -> str:
    """The name of the middleware: this project's own, since messages never leave its processes."""
    return "rmw_robot_kit"


def get_available_rmw_implementations() -> set[str]:
    """The names of all middlewares that could be used: one."""
    return {get_rmw_implementation_identifier()}


def remove_ros_args(args: Sequence[str] | None = None) -> list[str]:
    """The command line without its ROS arguments."""
    return split_ros_arguments(sys.argv if args is None else args)[0]


def install_signal_handlers(context: Context, options: SignalHandlerOptions) -> None:
    """Makes signals shut the context down, before their previous handlers run. Only in the main thread."""
    if threading.current_thread() is not threading.main_thread():
        return
    for flag in (SignalHandlerOptions.SIGINT, SignalHandlerOptions.SIGTERM):
        if flag in options:
            _install(context, signal.Signals[str(flag.name)])


def _install(context: Context, number: signal.Signals) -> None:
    before = signal.getsignal(number)

    def handle(received: int, frame: FrameType | None) -> None:
        context.shutdown_from_outside()
        if callable(before):
            before(received, frame)

    def restore() -> None:
        if threading.current_thread() is threading.main_thread() and signal.getsignal(number) is handle:
            signal.signal(number, before)

    signal.signal(number, handle)
    context.on_shutdown(restore)


def initialize_logging() -> None:
    """No-op: the log is there from the start. rclpy's name for it is ``rclpy.logging.initialize``."""


def shutdown_logging() -> None:
    """Forgets the levels of all loggers, as the next program would find them: ``rclpy.logging.shutdown``."""
    get_default_context().graph.log.levels.clear()


def get_logger(name: str) -> RcutilsLogger:
    """A logger that belongs to no node."""
    if not name:
        raise ValueError("Logger name must not be empty")
    return RcutilsLogger(name, get_default_context().graph.log)


def set_logger_level(name: str, level: LoggingSeverity | int, detailed_error: bool = False) -> None:
    """Drops lines of the logger, and of its children, below this level."""
    get_logger(name).set_level(level)


def get_logger_level(name: str) -> LoggingSeverity:
    """The level set for this logger itself; UNSET if none is."""
    return get_default_context().graph.log.levels.get(name, LoggingSeverity.UNSET)


def get_logger_effective_level(name: str) -> LoggingSeverity:
    """The effective level: the logger's own, its nearest ancestor's, or the default."""
    return get_logger(name).get_effective_level()


def timeout_sec_to_nsec(timeout_sec: float | None) -> int:
    """Nanoseconds; -1 for ever, which None and negative numbers mean."""
    return -1 if timeout_sec is None or timeout_sec < 0 else int(timeout_sec * S_TO_NS)


def wait_for_message(
    msg_type: type[M],
    node: Node,
    topic: str,
    *,
    qos_profile: QoSProfile | int = 1,
    time_to_wait: float = -1,
) -> tuple[bool, M | None]:
    """Waits for the next message on a topic without spinning the node; returns ``(True, message)``.

    ``(False, None)`` after ``time_to_wait`` seconds of the graph's time, negative for no limit, or after a
    shutdown.
    """
    context, graph = node.context, node.handle.graph
    received: list[Any] = []

    def arrived() -> bool:
        # The queue is looked at directly, since no thread may be spinning the node.
        return bool(received) or subscription.has_messages or not context.ok()

    subscription = node.create_subscription(msg_type, topic, received.append, qos_profile)
    try:
        until = None if time_to_wait < 0 else graph.now_ns + int(time_to_wait * S_TO_NS)
        graph.wait(arrived, until, what=f"wait_for_message() on '{subscription.topic_name}'")
        received += subscription.take_messages()
    finally:
        node.destroy_subscription(subscription)
    return (True, received[0]) if received else (False, None)
