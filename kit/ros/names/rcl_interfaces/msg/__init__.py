from kit.msg.rcl_interfaces import (
    FloatingPointRange,
    IntegerRange,
    ListParametersResult,
    Log,
    Parameter,
    ParameterDescriptor,
    ParameterEvent,
    ParameterEventDescriptors,
    ParameterType,
    ParameterValue,
    SetParametersResult,
)

__all__ = [
    "FloatingPointRange",
    "IntegerRange",
    "ListParametersResult",
    "Log",
    "Parameter",
    "ParameterDescriptor",
    "ParameterEvent",
    "ParameterEventDescriptors",
    "ParameterType",
    "ParameterValue",
    "SetParametersResult",
]
