"""How far the controller of a lesson's scene is confined."""

from __future__ import annotations

from kit.host.sandbox.confinement import INTERACTIVE_LEVEL, Level
from kit.host.sandbox.probe import highest_level_up_to
from kit.school.lessons.records import LessonScene


def scene_level(scene: LessonScene) -> Level:
    """The kit's own controllers run as a student's do; somebody else's as confined as this machine can.

    Slow the first time: the machine is asked what it can.
    """
    return highest_level_up_to(max(Level)) if scene.is_foreign else INTERACTIVE_LEVEL
