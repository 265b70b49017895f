"""Names of nodes, topics, services and parameters: what is allowed, and what a relative name means."""

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

_STRANGE_IN_NODE = re.compile(r"[^A-Za-z0-9_]")
_STRANGE_IN_PATH = re.compile(r"[^A-Za-z0-9_/]")
_STRANGE_IN_TOPIC = re.compile(r"[^A-Za-z0-9_/~{}]")
_SUBSTITUTION = re.compile(r"\{([^{}]*)\}")


def validate_node_name(node_name: str) -> bool:
    """True. Raises InvalidNodeNameException: letters, digits and underscores, no digit first."""
    fail: _Fail = InvalidNodeNameException
    if not node_name:
        raise fail(node_name, "node name must not be empty", 0)
    _only(
        node_name,
        _STRANGE_IN_NODE,
        "node name must not contain characters other than alphanumerics or '_'",
        fail,
    )
    if node_name[0].isdigit():
        raise fail(node_name, "node name must not start with a number", 0)
    if len(node_name) > MAX_NAME_LENGTH:
        raise fail(
            node_name, f"node name must not be longer than {MAX_NAME_LENGTH} characters", MAX_NAME_LENGTH
        )
    return True


def validate_namespace(namespace: str) -> bool:
    """True. Raises InvalidNamespaceException: absolute, no slash at the end."""
    fail: _Fail = InvalidNamespaceException
    if not namespace:
        raise fail(namespace, "namespace must not be empty", 0)
    if not namespace.startswith("/"):
        raise fail(namespace, "namespace must be absolute, it must lead with a '/'", 0)
    _path(namespace, "namespace", _STRANGE_IN_PATH, fail)
    return True


def validate_topic_name(name: str, *, is_service: bool = False) -> bool:
    """True. Raises InvalidTopicNameException or InvalidServiceNameException; ``~`` and ``{}`` are allowed."""
    what = "service name" if is_service else "topic name"
    fail: _Fail = InvalidServiceNameException if is_service else InvalidTopicNameException
    if not isinstance(name, str):
        raise TypeError(f"a {what} is a text, not {type(name).__name__}")
    if not name:
        raise fail(name, f"{what} must not be empty", 0)
    _path(name, what, _STRANGE_IN_TOPIC, fail)
    for found in re.finditer("~", name):
        if found.start() != 0:
            raise fail(name, f"{what} must not have '~' anywhere but at the start", found.start())
    if name.startswith("~") and len(name) > 1 and name[1] != "/":
        raise fail(name, f"{what} has tilde ('~') without a following forward slash ('/')", 1)
    rest = _SUBSTITUTION.sub(lambda match: "_" * len(match[0]), name)
    for brace in "{}":
        if brace in rest:
            raise fail(name, f"{what} has unbalanced curly braces", rest.index(brace))
    return True


def validate_full_topic_name(name: str, *, is_service: bool = False) -> bool:
    """True. As ``validate_topic_name``, for a name that must already be absolute."""
    fail: _Fail = InvalidServiceNameException if is_service else InvalidTopicNameException
    what = "service name" if is_service else "topic name"
    if not name.startswith("/"):
        raise fail(name, f"{what} must be absolute, it must lead with a '/'", 0)
    _path(name, what, _STRANGE_IN_PATH, fail)
    return True


def validate_parameter_name(name: str) -> bool:
    """True. Raises InvalidParameterException for an empty name, TypeError for something else than a text."""
    if not isinstance(name, str):
        raise TypeError(f"a parameter name is a text, not {type(name).__name__}")
    if not name:
        raise InvalidParameterException(name)
    return True


def expand_topic_name(topic_name: str, node_name: str, node_namespace: str) -> str:
    """The absolute name of what a node calls ``topic_name``: ``~/x``, ``x`` or ``/x``, with ``{node}``, ``{ns}``.

    Raises InvalidTopicNameException for an unknown substitution. The names given must be valid.
    """
    namespace = "" if node_namespace == "/" else node_namespace
    values = {"node": node_name, "ns": namespace.lstrip("/"), "namespace": namespace.lstrip("/")}

    def replaced(match: re.Match[str]) -> str:
        if match[1] not in values:
            raise InvalidTopicNameException(topic_name, f"unknown substitution '{match[0]}'", match.start())
        return values[match[1]]

    name = _SUBSTITUTION.sub(replaced, topic_name)
    if name.startswith("~"):
        name = f"{namespace}/{node_name}{name[1:]}"
    elif not name.startswith("/"):
        name = f"{namespace}/{name}"
    return name


def topic_or_service_is_hidden(name: str) -> bool:
    """Whether lists leave it out: a part of its name begins with an underscore."""
    return any(part.startswith("_") for part in name.split("/"))


def full_name(name: str, namespace: str) -> str:
    """``/ns/name``."""
    return f"/{name}" if namespace == "/" else f"{namespace}/{name}"


def absolute_namespace(namespace: str | None) -> str:
    """A namespace as ``create_node`` takes it, with its slash in front; nothing is the root."""
    if not namespace:
        return "/"
    return namespace if namespace.startswith("/") else f"/{namespace}"


_Fail = Callable[[str, str, int], NameValidationException]
"""Makes the exception: the name, what is wrong with it, and where."""


def _only(name: str, strange: re.Pattern[str], message: str, fail: _Fail) -> None:
    found = strange.search(name)
    if found:
        raise fail(name, message, found.start())


def _path(name: str, what: str, strange: re.Pattern[str], fail: _Fail) -> None:
    """The rules that namespaces, topics and services share."""
    found = strange.search(name)
    if found:
        allowed = (
            "alphanumerics, '_', '~', '{', or '}'"
            if strange is _STRANGE_IN_TOPIC
            else "alphanumerics, '_' or '/'"
        )
        raise fail(name, f"{what} must not contain characters other than {allowed}", found.start())
    if len(name) > 1 and name.endswith("/"):
        raise fail(name, f"{what} must not end with a '/'", len(name) - 1)
    if "//" in name:
        raise fail(name, f"{what} must not contain repeated '/'", name.index("//"))
    number = re.search(r"(?:^|/)(\d)", name)
    if number:
        raise fail(name, f"{what} token must not start with a number", number.start(1))
