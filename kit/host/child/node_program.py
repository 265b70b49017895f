"""Runs a ROS 2 program in the child: its nodes are in a graph whose time and messages come from the kit."""

from __future__ import annotations

import atexit
import importlib
import os
import re
import sys
import time
from collections.abc import Callable
from functools import partial
from types import ModuleType
from typing import Final

from kit.host.child.command_loop import CommandSession
from kit.host.child.program_input import mark_reading
from kit.host.child.simulated_time import use_simulated_time
from kit.host.child.simulated_waits import SimulatedWaits
from kit.host.child.student_module import StudentProgram, exit_status
from kit.host.child.subprocesses import answer_ticks_meanwhile
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.graph_bridge import ChildBridge
from kit.host.waiter import AllThreadsWaiter
from kit.host.wire import Json
from kit.ros import SHIMS_FOLDER, install_import_names
from kit.ros.execution.context import set_default_graph_finder
from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node

CALL_OF_MAIN: Final = re.compile(rb"^(?!def |async |class |#|@)(?=\S).*\bmain\(", re.MULTILINE)
"""A line of a file, and not of a function of it, that may call ``main()``."""
SWITCH_S: Final = 0.0005
"""How long one of the program's threads may keep the interpreter while others want it [s]."""


def run(program: StudentProgram, session: CommandSession, start: dict[str, Json]) -> None:
    """Runs the program from its start to its end: its ``main()``, or its one class of nodes."""
    as_package = (
        "folder" in start and not start["is_controller"]
    )  # run as ``ros2 run`` would: what it prints may be all that it does
    atexit._clear()  # what the kit's own modules have registered is not the program's
    install_import_names(start.get("interfaces", {}))
    # Last, so that what is really installed comes first.
    sys.path.append(SHIMS_FOLDER)
    sys.argv = [program.file, *start["args"]]
    bridge = ChildBridge(session, start["now"], uninterrupted=session.interrupts.deferred)
    set_default_graph_finder(lambda: bridge.graph)
    waits = use_simulated_time(bridge.graph, start["libraries"])
    waiter = bridge.graph.waiter
    assert isinstance(waiter, AllThreadsWaiter)  # the bridge's default
    waiter.max_computing_s = session.reply_s / 2
    # A tick needs the interpreter several times: a thread that computes or polls must not keep it for long each time.
    sys.setswitchinterval(SWITCH_S)
    if "folder" in start:  # the user's own, not a submission
        answer_ticks_meanwhile(partial(waiter.waiting_for_user, bridge.graph))
    os.register_at_fork(after_in_child=partial(_leave_graph, bridge, session))
    session.interrupts.install()
    bridge.on_interrupt = session.interrupts.ask
    if start["has_input"]:
        mark_reading(partial(waiter.waiting_for_user, bridge.graph))
    bridge.graph.directory.replaced_names = frozenset(start.get("replaced", ()))
    if start["events"] is None:
        _begin_when_needed(bridge, session, start["start_s"], start["start_wall_s"])
    else:
        bridge.apply_events(start["events"])
    try:
        if "launch_test" in start:
            from kit.host.child import launch_test_program  # here: every program's start would pay for it

            launch_test_program.run(program, bridge, start["launch_test"])
        elif start.get("entry"):
            _run_entry_point(start["entry"], program)
        else:
            module = program.load("__main__")
            # A file that calls main() itself, or asks for its own name, calls what it wants to have called.
            calls_itself = (as_package and b"__main__" in program.source) or _calls_main(program.source)
            if not (bridge.has_had_nodes or calls_itself):
                _run_main(module, program)
    except SystemExit as stop:
        if exit_status(stop):
            _end_program(waits, session)
            bridge.send_last_messages()
            raise
    except MemoryError:
        raise
    except KeyboardInterrupt:
        if not session.interrupts.are_asked:
            bridge.send_last_messages()
            raise
        _end_program(waits, session)
        bridge.end(by_interrupt=True)
    except BaseException:
        bridge.send_last_messages()
        raise
    _end_program(waits, session)
    if not bridge.has_had_nodes and not as_package:
        raise _no_program_error("The program ended without creating a node.", program)
    bridge.end()


def _leave_graph(bridge: ChildBridge, session: CommandSession) -> None:
    """In a process that the program has forked, as multiprocessing does: it has no part in the graph."""
    bridge.leave()
    session.leave(bridge.graph.now_ns)
    set_default_graph_finder(_refuse_graph)


def _refuse_graph() -> Graph:
    raise RuntimeError(
        "nodes cannot be in a process that the program has forked, as multiprocessing does: start each as a program of its "
        "own, with a launch file or `ros2 run`"
    )


def _end_program(waits: SimulatedWaits, session: CommandSession) -> None:
    """Does what Python does when a program has ended: waits for its threads, or until it is asked to end, then calls what it
    has registered with atexit."""
    try:
        waits.wait_for_threads()
    except KeyboardInterrupt:
        if not session.interrupts.are_asked:
            raise
    atexit._run_exitfuncs()


def _begin_when_needed(
    bridge: ChildBridge, session: CommandSession, start_s: float, start_wall_s: float
) -> None:
    """Makes the program wait for the parent's graph when it first needs one: so a file that cannot be loaded needs none.

    ``start_s``, ``start_wall_s``: how long the program may take to start, by processor time and by the wall clock [s], the
    wait for the parent not counted.
    """
    began = time.process_time()

    def find_graph() -> Graph:
        if not bridge.has_ticked:
            left_s = start_s - (time.process_time() - began)
            bridge.next_tick(None)
            session.set_deadline(max(SWITCH_S, left_s), start_wall_s)
        return bridge.graph

    set_default_graph_finder(find_graph)


def _run_entry_point(entry: str, program: StudentProgram) -> None:
    """Calls the function of an entry point, as the script would that an installation makes of it."""
    name, _, function = entry.partition(":")
    module = importlib.import_module(name)
    main = getattr(module, function, None)
    if not callable(main):
        raise _no_program_error(
            f"{name} has no {function}(), which setup.py or a launch file names as an entry point.",
            program,
        )
    if isinstance(main, type) and issubclass(main, Node):  # a composable node
        _spin(main)
        return
    result = main()
    if result not in (None, 0):
        raise SystemExit(result)


def _calls_main(source: bytes) -> bool:
    """Whether a file, outside its functions and classes, calls ``main()``."""
    if not CALL_OF_MAIN.search(source):  # as of nearly all: nothing is parsed once more
        return False
    import ast  # few programs need it, and each start would pay for it

    defined = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
    outside = [each for each in ast.parse(source).body if not isinstance(each, defined)]
    calls = (node for each in outside for node in ast.walk(each) if isinstance(node, ast.Call))
    return any(isinstance(call.func, ast.Name) and call.func.id == "main" for call in calls)


def _run_main(module: ModuleType, program: StudentProgram) -> None:
    """Calls the file's ``main()``, or spins its one class of nodes, as ``ros2 run`` would."""
    main = getattr(module, "main", None)
    if callable(main):
        main()
        return
    classes = [cls for cls in vars(module).values() if isinstance(cls, type) and issubclass(cls, Node)]
    own = [cls for cls in classes if cls.__module__ == module.__name__]
    last = [cls for cls in own if not any(cls is not other and issubclass(other, cls) for other in own)]
    if len(last) != 1:
        found = "none" if not last else " and ".join(cls.__name__ for cls in last)
        raise _no_program_error(
            f"There is no main() to call. Without it, the file needs exactly one class derived from Node; it has {found}.",
            program,
        )
    _spin(last[0])


def _spin(make: Callable[[], Node]) -> None:
    import rclpy

    rclpy.init()
    rclpy.spin(make())


def _no_program_error(message: str, program: StudentProgram) -> StudentCodeError:
    return StudentCodeError(Failure(FailureKind.EXCEPTION, message, program.relative_path(program.file)))
