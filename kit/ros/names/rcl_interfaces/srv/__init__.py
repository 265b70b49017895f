from kit.msg.rcl_interfaces import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
)

__all__ = [
    "DescribeParameters",
    "GetParameterTypes",
    "GetParameters",
    "ListParameters",
    "SetParameters",
    "SetParametersAtomically",
]
