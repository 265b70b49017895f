"""Exceptions: those of rclpy under its names, and a few that explain what fails silently in ROS 2."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from kit.ros.parameters.parameter import Parameter


class NotInitializedException(Exception):
    """A context was used before ``rclpy.init()`` or after ``rclpy.shutdown()``."""

    def __init__(self, *what: object) -> None:
        super().__init__("rclpy.init() has not been called", *what)


class NoTypeSupportImportedException(Exception):
    """A message class was expected."""


class RCLError(RuntimeError):
    """An operation that the state of an action's goal or of a lifecycle node does not allow."""


class ServerGoneError(RuntimeError):
    """The node that served a service or an action has gone while a call waited for its answer."""


class InvalidHandle(Exception):
    """A publisher, subscription, client, service, timer or node was used after it had been destroyed."""


class ROSInterruptException(Exception):
    """A sleeping rate or clock was woken by ``rclpy.shutdown()``."""

    def __init__(self) -> None:
        super().__init__("rclpy.shutdown() has been called")


class TimerCancelledError(Exception):
    """A cancelled timer was called."""


class TimeoutException(Exception):
    """A wait has reached its time-out."""


class ShutdownException(Exception):
    """The executor was shut down."""


class ExternalShutdownException(Exception):
    """The context was shut down from outside: a signal, another thread, the end of a run."""

    def __init__(self, *args: object) -> None:
        super().__init__(*(args or ("the context has been shut down",)))


class ConditionReachedException(Exception):
    """The awaited future is done."""


class WouldDeadlock(RuntimeError):
    """A call that would never return: on a robot it hangs silently; here the message says why."""


class NodeFailure(RuntimeError):
    """A callback of the node ``node_name`` raised ``cause`` (also ``__cause__``) while nodes ran in lock-step."""

    def __init__(self, node_name: str | None, cause: BaseException) -> None:
        self.node_name = node_name
        self.cause = cause
        self.__cause__ = cause
        super().__init__(f"{node_name or 'a task'} failed: {type(cause).__name__}: {cause}")


class NameValidationException(Exception):
    """A name that ROS 2 does not allow; ``invalid_index`` is the position of the error."""

    def __init__(self, name_type: str, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__(f"Invalid {name_type}: {error_msg}:\n  '{name}'\n   {' ' * invalid_index}^")
        self.name_type = name_type
        self.name = name
        self.error_msg = error_msg
        self.invalid_index = invalid_index


class InvalidNamespaceException(NameValidationException):
    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("namespace", name, error_msg, invalid_index)


class InvalidNodeNameException(NameValidationException):
    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("node name", name, error_msg, invalid_index)


class InvalidTopicNameException(NameValidationException):
    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("topic name", name, error_msg, invalid_index)


class InvalidServiceNameException(NameValidationException):
    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("service name", name, error_msg, invalid_index)


class InvalidRosArguments(ValueError):
    """An argument after ``--ros-args`` is wrong; the message names it and shows the right form."""


class ParameterException(Exception):
    """Base class of parameter errors."""

    def __init__(self, message: str, parameters: str | Iterable[str]) -> None:
        names = [parameters] if isinstance(parameters, str) else list(parameters)
        super().__init__(message, names)

    def __str__(self) -> str:
        message, names = self.args
        return f"{message}: {', '.join(names)}"


class ParameterNotDeclaredException(ParameterException):
    def __init__(self, parameters: str | Iterable[str], near: str = "") -> None:
        hint = f" (did you mean '{near}'?)" if near else ""
        super().__init__(f"Invalid access to undeclared parameter(s){hint}", parameters)


class ParameterAlreadyDeclaredException(ParameterException):
    def __init__(self, parameters: str | Iterable[str]) -> None:
        super().__init__("Parameter(s) already declared", parameters)


class ParameterImmutableException(ParameterException):
    def __init__(self, parameters: str | Iterable[str]) -> None:
        super().__init__("Attempted to modify read-only parameter(s)", parameters)


class ParameterUninitializedException(ParameterException):
    """A parameter was declared with a type only, and has no value."""

    def __init__(self, parameters: str | Iterable[str]) -> None:
        super().__init__("The parameter is not initialized", parameters)


class InvalidParameterException(ParameterException):
    """A parameter name that ROS 2 does not allow."""

    def __init__(self, parameter: str) -> None:
        super().__init__("Invalid parameter name", parameter)


class InvalidParameterTypeException(ParameterException):
    def __init__(self, desired_parameter: Parameter, expected_type: str) -> None:
        super().__init__(
            f"Trying to set parameter '{desired_parameter.name}' to '{desired_parameter.value}' of type "
            f"'{desired_parameter.type_.name}', expecting type '{expected_type}'",
            desired_parameter.name,
        )

    def __str__(self) -> str:
        return str(self.args[0])


class InvalidParameterValueException(ParameterException):
    def __init__(self, parameter: str, value: object, reason: str) -> None:
        super().__init__(f"Invalid parameter value ({value}) for parameter. Reason: {reason}", parameter)


class NodeNameNonExistentError(RuntimeError):
    """No node of this name is in the graph."""
