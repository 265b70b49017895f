"""ROS 2's launch, as this project offers it."""

from kit.ros.launch.actions import LaunchDescriptionSource
from kit.ros.launch.context import LaunchContext
from kit.ros.launch.entity import Action, Condition, LaunchDescription, LaunchDescriptionEntity
from kit.ros.launch.event_handlers import EventHandler
from kit.ros.launch.events import Event
from kit.ros.launch.substitutions import SomeText as SomeSubstitutionsType
from kit.ros.launch.substitutions import Substitution

__all__ = [
    "Action",
    "Condition",
    "Event",
    "EventHandler",
    "LaunchContext",
    "LaunchDescription",
    "LaunchDescriptionEntity",
    "LaunchDescriptionSource",
    "SomeSubstitutionsType",
    "Substitution",
]
