from kit.msg.lifecycle_msgs import State as State
from kit.msg.lifecycle_msgs import Transition as Transition
from kit.msg.lifecycle_msgs import TransitionDescription as TransitionDescription
from kit.msg.lifecycle_msgs import TransitionEvent as TransitionEvent
