from array import array as _array
from typing import ClassVar as _ClassVar

import numpy as _np
from numpy.typing import NDArray as _NDArray

from kit.msg.message import Action as _Action
from kit.msg.message import Message as _Message
from kit.msg.message import Service as _Service

class State(_Message):
    PRIMARY_STATE_UNKNOWN: _ClassVar[int]
    PRIMARY_STATE_UNCONFIGURED: _ClassVar[int]
    PRIMARY_STATE_INACTIVE: _ClassVar[int]
    PRIMARY_STATE_ACTIVE: _ClassVar[int]
    PRIMARY_STATE_FINALIZED: _ClassVar[int]
    TRANSITION_STATE_CONFIGURING: _ClassVar[int]
    TRANSITION_STATE_CLEANINGUP: _ClassVar[int]
    TRANSITION_STATE_SHUTTINGDOWN: _ClassVar[int]
    TRANSITION_STATE_ACTIVATING: _ClassVar[int]
    TRANSITION_STATE_DEACTIVATING: _ClassVar[int]
    TRANSITION_STATE_ERRORPROCESSING: _ClassVar[int]
    id: int = ...
    label: str = ...
class Transition(_Message):
    TRANSITION_CREATE: _ClassVar[int]
    TRANSITION_CONFIGURE: _ClassVar[int]
    TRANSITION_CLEANUP: _ClassVar[int]
    TRANSITION_ACTIVATE: _ClassVar[int]
    TRANSITION_DEACTIVATE: _ClassVar[int]
    TRANSITION_UNCONFIGURED_SHUTDOWN: _ClassVar[int]
    TRANSITION_INACTIVE_SHUTDOWN: _ClassVar[int]
    TRANSITION_ACTIVE_SHUTDOWN: _ClassVar[int]
    TRANSITION_DESTROY: _ClassVar[int]
    TRANSITION_ON_CONFIGURE_SUCCESS: _ClassVar[int]
    TRANSITION_ON_CONFIGURE_FAILURE: _ClassVar[int]
    TRANSITION_ON_CONFIGURE_ERROR: _ClassVar[int]
    TRANSITION_ON_CLEANUP_SUCCESS: _ClassVar[int]
    TRANSITION_ON_CLEANUP_FAILURE: _ClassVar[int]
    TRANSITION_ON_CLEANUP_ERROR: _ClassVar[int]
    TRANSITION_ON_ACTIVATE_SUCCESS: _ClassVar[int]
    TRANSITION_ON_ACTIVATE_FAILURE: _ClassVar[int]
    TRANSITION_ON_ACTIVATE_ERROR: _ClassVar[int]
    TRANSITION_ON_DEACTIVATE_SUCCESS: _ClassVar[int]
    TRANSITION_ON_DEACTIVATE_FAILURE: _ClassVar[int]
    TRANSITION_ON_DEACTIVATE_ERROR: _ClassVar[int]
    TRANSITION_ON_SHUTDOWN_SUCCESS: _ClassVar[int]
    TRANSITION_ON_SHUTDOWN_FAILURE: _ClassVar[int]
    TRANSITION_ON_SHUTDOWN_ERROR: _ClassVar[int]
    TRANSITION_ON_ERROR_SUCCESS: _ClassVar[int]
    TRANSITION_ON_ERROR_FAILURE: _ClassVar[int]
    TRANSITION_ON_ERROR_ERROR: _ClassVar[int]
    TRANSITION_CALLBACK_SUCCESS: _ClassVar[int]
    TRANSITION_CALLBACK_FAILURE: _ClassVar[int]
    TRANSITION_CALLBACK_ERROR: _ClassVar[int]
    id: int = ...
    label: str = ...
class TransitionDescription(_Message):
    transition: Transition = ...
    start_state: State = ...
    goal_state: State = ...
class TransitionEvent(_Message):
    timestamp: int = ...
    transition: Transition = ...
    start_state: State = ...
    goal_state: State = ...
class ChangeState(_Service):
    class Request(_Message):
        transition: Transition = ...
    class Response(_Message):
        success: bool = ...
class GetAvailableStates(_Service):
    class Request(_Message):
        pass
    class Response(_Message):
        available_states: list[State] = ...
class GetAvailableTransitions(_Service):
    class Request(_Message):
        pass
    class Response(_Message):
        available_transitions: list[TransitionDescription] = ...
class GetState(_Service):
    class Request(_Message):
        pass
    class Response(_Message):
        current_state: State = ...
