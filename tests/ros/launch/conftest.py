"""Carries out launch descriptions without starting anything."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from kit.ros.launch.entity import LaunchDescription
from kit.ros.launch.service import LaunchService

Carry = Callable[..., LaunchService]


class Play:
    """A run of a description: what it has asked for so far."""

    def __init__(self, *entities: Any, environment: dict[str, str] | None = None, **arguments: str) -> None:
        self.service = LaunchService("/pkg/launch/top.launch.py", arguments, environment=environment or {})
        self.requests = self.service.start(LaunchDescription(list(entities)))

    def advance(self, seconds: float = 0.0, *events: Any) -> list[Any]:
        """What it asks for next."""
        self.requests = self.service.advance(int(seconds * 1e9), [list(each) for each in events])
        return self.requests

    @property
    def kinds(self) -> list[str]:
        return [kind for kind, *_ in self.requests]

    @property
    def said(self) -> list[str]:
        return [content[1] for kind, *content in self.requests if kind == "log"]

    @property
    def started(self) -> list[dict[str, Any]]:
        """The specifications of the processes to be started."""
        return [content[1] for kind, *content in self.requests if kind == "process"]

    @property
    def arguments(self) -> list[str]:
        """Of the only process."""
        (specification,) = self.started
        found: list[str] = specification["arguments"]
        return found


@pytest.fixture
def play() -> type[Play]:
    return Play
