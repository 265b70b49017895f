from array import array as _array
from typing import ClassVar as _ClassVar

import numpy as _np
from numpy.typing import NDArray as _NDArray

from kit.msg.message import Action as _Action
from kit.msg.message import Message as _Message
from kit.msg.message import Service as _Service

class Empty(_Service):
    class Request(_Message):
        pass
    class Response(_Message):
        pass
class SetBool(_Service):
    class Request(_Message):
        data: bool = ...
    class Response(_Message):
        success: bool = ...
        message: str = ...
class Trigger(_Service):
    class Request(_Message):
        pass
    class Response(_Message):
        success: bool = ...
        message: str = ...
