from array import array as _array
from typing import ClassVar as _ClassVar

import numpy as _np
from numpy.typing import NDArray as _NDArray

from kit.msg import builtin_interfaces as builtin_interfaces
from kit.msg import std_msgs as std_msgs
from kit.msg.message import Action as _Action
from kit.msg.message import Message as _Message
from kit.msg.message import Service as _Service

class GoalID(_Message):
    stamp: builtin_interfaces.Time = ...
    id: str = ...
class GoalStatus(_Message):
    PENDING: _ClassVar[int]
    ACTIVE: _ClassVar[int]
    PREEMPTED: _ClassVar[int]
    SUCCEEDED: _ClassVar[int]
    ABORTED: _ClassVar[int]
    REJECTED: _ClassVar[int]
    PREEMPTING: _ClassVar[int]
    RECALLING: _ClassVar[int]
    RECALLED: _ClassVar[int]
    LOST: _ClassVar[int]
    goal_id: GoalID = ...
    status: int = ...
    text: str = ...
class GoalStatusArray(_Message):
    header: std_msgs.Header = ...
    status_list: list[GoalStatus] = ...
