from array import array as _array
from typing import ClassVar as _ClassVar

import numpy as _np
from numpy.typing import NDArray as _NDArray

from kit.msg import builtin_interfaces as builtin_interfaces
from kit.msg.message import Action as _Action
from kit.msg.message import Message as _Message
from kit.msg.message import Service as _Service

class MetricsMessage(_Message):
    measurement_source_name: str = ...
    metrics_source: str = ...
    unit: str = ...
    window_start: builtin_interfaces.Time = ...
    window_stop: builtin_interfaces.Time = ...
    statistics: list[StatisticDataPoint] = ...
class StatisticDataPoint(_Message):
    data_type: int = ...
    data: float = ...
class StatisticDataType(_Message):
    STATISTICS_DATA_TYPE_UNINITIALIZED: _ClassVar[int]
    STATISTICS_DATA_TYPE_AVERAGE: _ClassVar[int]
    STATISTICS_DATA_TYPE_MINIMUM: _ClassVar[int]
    STATISTICS_DATA_TYPE_MAXIMUM: _ClassVar[int]
    STATISTICS_DATA_TYPE_STDDEV: _ClassVar[int]
    STATISTICS_DATA_TYPE_SAMPLE_COUNT: _ClassVar[int]
