from array import array as _array
from typing import ClassVar as _ClassVar

import numpy as _np
from numpy.typing import NDArray as _NDArray

from kit.msg import builtin_interfaces as builtin_interfaces
from kit.msg.message import Action as _Action
from kit.msg.message import Message as _Message
from kit.msg.message import Service as _Service

class Clock(_Message):
    clock: builtin_interfaces.Time = ...
