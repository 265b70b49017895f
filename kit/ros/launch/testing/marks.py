"""How a launch file says what is to be tested: when its tests may begin, which come after the end, with which values."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import Any, Final, TypeVar

from kit.ros.launch.context import LaunchContext
from kit.ros.launch.entity import Action, LaunchDescriptionEntity
from kit.ros.launch.processes import ExecuteProcess

Function = TypeVar("Function", bound=Callable[..., Any])

EXIT_OK: Final = 0
EXIT_SIGINT: Final = 130
EXIT_SIGQUIT: Final = 131
EXIT_SIGKILL: Final = 137
EXIT_SIGSEGV: Final = 139
EXIT_FORCED: Final = 1
DEFAULT_ATTEMPTS: Final = 5


class ReadyToTest(Action):
    """Says that tests may begin: ``kit launch`` goes on without a word, as ``ros2 launch`` does."""

    def execute(self, context: LaunchContext) -> Iterable[LaunchDescriptionEntity] | None:
        context.on_ready_to_test()
        return None


class KeepAliveProc(ExecuteProcess):
    """Keeps a launch under test going when the processes under test have ended: a program of the kit's own, which waits."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(cmd=["sleep", "infinity"], name="keep_alive", **kwargs)

    def specification(self, context: LaunchContext) -> dict[str, Any]:
        program = {"package": "launch_testing", "executable": "keep_alive", "arguments": []}
        return {**super().specification(context), "kind": "node", **program}


def post_shutdown_test() -> Callable[[type], type]:
    """Marks a class of tests that run after the processes have ended."""

    def mark(cls: type) -> type:
        cls.__post_shutdown_test__ = True  # type: ignore[attr-defined]  # what launch_testing looks for
        return cls

    return mark


def keep_alive(function: Function) -> Function:
    """Marks a launch description that goes on though its processes may end before its tests."""
    function.__launch_test_keep_alive__ = True  # type: ignore[attr-defined]  # likewise
    return function


def ready_to_test_action_timeout(timeout: float) -> Callable[[Function], Function]:
    """Marks a launch description with how long its tests wait for ReadyToTest [s]."""

    def mark(function: Function) -> Function:
        function.__ready_to_test_action_timeout__ = timeout  # type: ignore[attr-defined]  # likewise
        return function

    return mark


def parametrize(
    argnames: str | Iterable[str], argvalues: Iterable[Any]
) -> Callable[[Function], Callable[[], list[tuple[Callable[..., Any], dict[str, Any]]]]]:
    """Makes of a launch description's function one for each value, or tuple of values, of its arguments, as pytest's does."""
    names = [name.strip() for name in argnames.split(",")] if isinstance(argnames, str) else list(argnames)

    def mark(function: Function) -> Callable[[], list[tuple[Callable[..., Any], dict[str, Any]]]]:
        def parametrized() -> list[tuple[Callable[..., Any], dict[str, Any]]]:
            sets = [dict(zip(names, [each] if len(names) == 1 else each, strict=True)) for each in argvalues]
            return [(partial(function, **values), values) for values in sets]

        parametrized.__parametrized__ = True  # type: ignore[attr-defined]  # what launch_testing looks for
        return parametrized

    return mark
