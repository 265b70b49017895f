"""Drives as lists of commands."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class DriveCommand:
    """A command that is held for a time."""

    ticks: int
    speed: float
    """Forward [m/s]; of the point between two robots."""
    turn: float
    """[rad/s], or the steering angle of a tricycle [rad]."""


@dataclass(frozen=True, slots=True)
class ReferenceDrive:
    """All commands of a drive, from the first tick on."""

    commands: tuple[DriveCommand, ...]
    seconds: float = 0.0
    """When it reaches the goal [simulated s]."""
