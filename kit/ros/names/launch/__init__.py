"""launch of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.launch.actions import LaunchDescriptionSource
from kit.ros.launch.context import LaunchContext
from kit.ros.launch.entity import Action, Condition, LaunchDescription, LaunchDescriptionEntity
from kit.ros.launch.event_handlers import EventHandler
from kit.ros.launch.events import Event
from kit.ros.launch.substitutions import SomeText as SomeSubstitutionsType, Substitution

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
