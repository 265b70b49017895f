from array import array as _array
from typing import ClassVar as _ClassVar

import numpy as _np
from numpy.typing import NDArray as _NDArray

from kit.msg import builtin_interfaces as builtin_interfaces
from kit.msg import unique_identifier_msgs as unique_identifier_msgs
from kit.msg.message import Action as _Action
from kit.msg.message import Message as _Message
from kit.msg.message import Service as _Service

class GoalInfo(_Message):
    goal_id: unique_identifier_msgs.UUID = ...
    stamp: builtin_interfaces.Time = ...
class GoalStatus(_Message):
    STATUS_UNKNOWN: _ClassVar[int]
    STATUS_ACCEPTED: _ClassVar[int]
    STATUS_EXECUTING: _ClassVar[int]
    STATUS_CANCELING: _ClassVar[int]
    STATUS_SUCCEEDED: _ClassVar[int]
    STATUS_CANCELED: _ClassVar[int]
    STATUS_ABORTED: _ClassVar[int]
    goal_info: GoalInfo = ...
    status: int = ...
class GoalStatusArray(_Message):
    status_list: list[GoalStatus] = ...
class CancelGoal(_Service):
    class Request(_Message):
        goal_info: GoalInfo = ...
    class Response(_Message):
        ERROR_NONE: _ClassVar[int]
        ERROR_REJECTED: _ClassVar[int]
        ERROR_UNKNOWN_GOAL_ID: _ClassVar[int]
        ERROR_GOAL_TERMINATED: _ClassVar[int]
        return_code: int = ...
        goals_canceling: list[GoalInfo] = ...
