"""Validates and expands the names of nodes, topics, services and parameters.

Actions in the graph: an action is three services and two topics, hidden under its name.

Which node serves or calls an action is read off the topic of its feedback, as ROS 2 does.
"""

from __future__ import annotations

import re
from collections.abc import Callable

from kit.ros.exceptions import (
    InvalidNamespaceException,
    InvalidNodeNameException,
    InvalidParameterException,
    InvalidServiceNameException,
    InvalidTopicNameException,
    NameValidationException,
)

TOPIC_SEPARATOR_STRING = "/"
MAX_NAME_LENGTH = 255
_INVALID_IN_NODE = re.compile(r"[^A-Za-z0-9_]")
_INVALID_IN_PATH = re.compile(r"[^A-Za-z0-9_/]")
_INVALID_IN_TOPIC = re.compile(r"[^A-Za-z0-9_/~{}]")
_SUBSTITUTION = re.compile(r"\{([^{}]*)\}")


def validate_node_name(node_name: str) -> bool:
    """Returns True. Raises InvalidNodeNameException: letters, digits and underscores, no digit first."""
    make_exception: _MakeException = InvalidNodeNameException
    if not node_name:
        raise make_exception(node_name, "node name must not be empty", 0)
    _check_characters(
        node_name,
        _INVALID_IN_NODE,
        "node name must not contain characters other than alphanumerics or '_'",
        make_exception,
    )
    if node_name[0].isdigit():
        raise make_exception(node_name, "node name must not start with a number", 0)
    if len(node_name) > MAX_NAME_LENGTH:
        raise make_exception(
            node_name, f"node name must not be longer than {MAX_NAME_LENGTH} characters", MAX_NAME_LENGTH
        )
    return True


def validate_namespace(namespace: str) -> bool:
    """Returns True. Raises InvalidNamespaceException: absolute, no slash at the end."""
    make_exception: _MakeException = InvalidNamespaceException
    if not namespace:
        raise make_exception(namespace, "namespace must not be empty", 0)
    if not namespace.startswith("/"):
        raise make_exception(namespace, "namespace must be absolute, it must lead with a '/'", 0)
    _check_path(namespace, "namespace", _INVALID_IN_PATH, make_exception)
    return True


def validate_topic_name(name: str, *, is_service: bool = False) -> bool:
    """Returns True. Raises InvalidTopicNameException or InvalidServiceNameException; ``~`` and ``{}`` are allowed."""
    what = "service name" if is_service else "topic name"
    make_exception: _MakeException = InvalidServiceNameException if is_service else InvalidTopicNameException
    if not isinstance(name, str):
        raise TypeError(f"a {what} is a text, not {type(name).__name__}")
    if not name:
        raise make_exception(name, f"{what} must not be empty", 0)
    _check_path(name, what, _INVALID_IN_TOPIC, make_exception)
    for found in re.finditer("~", name):
        if found.start() != 0:
            raise make_exception(name, f"{what} must not have '~' anywhere but at the start", found.start())
    if name.startswith("~") and len(name) > 1 and name[1] != "/":
        raise make_exception(name, f"{what} has tilde ('~') without a following forward slash ('/')", 1)
    opened: int | None = None
    for place, sign in enumerate(name if "{" in name or "}" in name else ""):
        if opened is None:
            if sign == "}":
                raise make_exception(name, f"{what} has unbalanced curly braces", place)
            opened = place if sign == "{" else None
        elif sign == "}":
            opened = None
        elif sign in "{/~":
            raise make_exception(
                name, f"{what} has a substitution with characters other than alphanumerics or '_'", place
            )
        elif place == opened + 1 and sign.isdigit():
            raise make_exception(name, f"{what} has a substitution that starts with a number", place)
    if opened is not None:
        raise make_exception(name, f"{what} has unbalanced curly braces", opened)
    return True


def validate_full_topic_name(name: str, *, is_service: bool = False) -> bool:
    """Validates as ``validate_topic_name`` does, for a name that must be absolute."""
    make_exception: _MakeException = InvalidServiceNameException if is_service else InvalidTopicNameException
    what = "service name" if is_service else "topic name"
    if not name.startswith("/"):
        raise make_exception(name, f"{what} must be absolute, it must lead with a '/'", 0)
    _check_path(name, what, _INVALID_IN_PATH, make_exception)
    return True


def validate_parameter_name(name: str) -> bool:
    """Returns True. Raises InvalidParameterException for an empty name, TypeError if it is no string."""
    if not isinstance(name, str):
        raise TypeError(f"a parameter name is a text, not {type(name).__name__}")
    if not name:
        raise InvalidParameterException(name)
    return True


def expand_topic_name(topic_name: str, node_name: str, node_namespace: str) -> str:
    """The absolute name of what a node calls ``topic_name``: ``~/x``, ``x`` or ``/x``, with ``{node}``, ``{ns}``.

    Raises ValueError for an unknown substitution. The names given must be valid.
    """
    namespace = "" if node_namespace == "/" else node_namespace
    values = {"node": node_name, "ns": node_namespace, "namespace": node_namespace}

    def replaced(match: re.Match[str]) -> str:
        if match[1] not in values:
            raise ValueError(f"the topic name '{topic_name}' has the unknown substitution '{match[0]}'")
        return values[match[1]]

    name = _SUBSTITUTION.sub(replaced, topic_name)
    if name.startswith("~"):
        name = f"{namespace}/{node_name}{name[1:]}"
    elif not name.startswith("/"):
        name = f"{namespace}/{name}"
    return name


def topic_or_service_is_hidden(name: str) -> bool:
    """True if lists leave it out: a part of its name begins with an underscore."""
    return any(part.startswith("_") for part in name.split("/"))


def full_name(name: str, namespace: str) -> str:
    """The full name of a node: ``/ns/name``."""
    return f"/{name}" if namespace == "/" else f"{namespace}/{name}"


def absolute_namespace(namespace: str | None) -> str:
    """The namespace with a leading slash; None or an empty text is the root."""
    if not namespace:
        return "/"
    return namespace if namespace.startswith("/") else f"/{namespace}"


_MakeException = Callable[[str, str, int], NameValidationException]
"""Makes the exception from the name, the error message and the position."""


def _check_characters(
    name: str, invalid: re.Pattern[str], message: str, make_exception: _MakeException
) -> None:
    found = invalid.search(name)
    if found:
        raise make_exception(name, message, found.start())


def _check_path(name: str, what: str, invalid: re.Pattern[str], make_exception: _MakeException) -> None:
    """Checks the rules that namespaces, topics and services share."""
    found = invalid.search(name)
    if found:
        allowed = (
            "alphanumerics, '_', '~', '{', or '}'"
            if invalid is _INVALID_IN_TOPIC
            else "alphanumerics, '_' or '/'"
        )
        raise make_exception(name, f"{what} must not contain characters other than {allowed}", found.start())
    if len(name) > 1 and name.endswith("/"):
        raise make_exception(name, f"{what} must not end with a '/'", len(name) - 1)
    if "//" in name:
        raise make_exception(name, f"{what} must not contain repeated '/'", name.index("//"))
    number = re.search(r"(?:^|/)(\d)", name)
    if number:
        raise make_exception(name, f"{what} token must not start with a number", number.start(1))
