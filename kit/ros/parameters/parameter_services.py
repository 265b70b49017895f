"""Services by which other programs read and set the parameters of a node."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from kit.msg.rcl_interfaces import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    ListParameters,
    ParameterDescriptor,
    ParameterValue,
    SetParameters,
    SetParametersAtomically,
    SetParametersResult,
)
from kit.ros.exceptions import ParameterException
from kit.ros.node.qos import qos_profile_parameters
from kit.ros.parameters.parameter import Parameter

if TYPE_CHECKING:
    from kit.ros.node.parameter_methods import NodeParameterMethods


class ParameterServices:
    """Six services under the node's name, as every ROS 2 node has them."""

    def __init__(self, node: NodeParameterMethods, create_service: Callable[..., object]) -> None:
        self._node = node
        for definition, name, callback in (
            (DescribeParameters, "describe_parameters", self._describe),
            (GetParameters, "get_parameters", self._get),
            (GetParameterTypes, "get_parameter_types", self._types),
            (ListParameters, "list_parameters", self._list),
            (SetParameters, "set_parameters", self._set),
            (SetParametersAtomically, "set_parameters_atomically", self._set_atomically),
        ):
            create_service(definition, f"~/{name}", callback, qos_profile=qos_profile_parameters)

    def _describe(self, request: Any, response: Any) -> Any:
        node = self._node
        response.descriptors = [
            node.describe_parameter(name) if node.has_parameter(name) else ParameterDescriptor(name=name)
            for name in request.names
        ]
        return response

    def _get(self, request: Any, response: Any) -> Any:
        response.values = [self._value(name) for name in request.names]
        return response

    def _types(self, request: Any, response: Any) -> Any:
        response.types = [self._value(name).type for name in request.names]
        return response

    def _list(self, request: Any, response: Any) -> Any:
        response.result = self._node.list_parameters(request.prefixes, request.depth)
        return response

    def _set(self, request: Any, response: Any) -> Any:
        results = []
        for message in request.parameters:
            try:
                results.append(self._node.set_parameters_atomically([Parameter.from_parameter_msg(message)]))
            except (ParameterException, RuntimeError) as problem:
                results.append(SetParametersResult(successful=False, reason=str(problem)))
        response.results = results
        return response

    def _set_atomically(self, request: Any, response: Any) -> Any:
        try:
            parameters = [Parameter.from_parameter_msg(message) for message in request.parameters]
            response.result = self._node.set_parameters_atomically(parameters)
        except (ParameterException, RuntimeError) as problem:
            response.result = SetParametersResult(successful=False, reason=str(problem))
        return response

    def _value(self, name: str) -> ParameterValue:
        """The value as a message; NOT_SET for an undeclared parameter or one without a value."""
        return self._node.get_parameter_or(name).get_parameter_value()
