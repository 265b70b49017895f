"""Stores the parameters of a node: values and descriptors, and the rules for changing them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from kit.msg.rcl_interfaces import ParameterDescriptor, ParameterEvent, SetParametersResult
from kit.ros.exceptions import (
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterNotDeclaredException,
)
from kit.ros.parameters.parameter import Parameter

OnSet = Callable[[list[Parameter]], SetParametersResult]
PreSet = Callable[[list[Parameter]], list[Parameter]]
PostSet = Callable[[list[Parameter]], None]

NOT_SET = Parameter.Type.NOT_SET
_WRONG_TYPE = "Wrong parameter type"


class ParameterStore:
    """The parameters of one node."""

    def __init__(self, overrides: dict[str, Parameter], *, allow_undeclared: bool) -> None:
        self.overrides = overrides
        """Values that replace the defaults when parameters are declared."""
        self.allow_undeclared = allow_undeclared
        self.values: dict[str, Parameter] = {}
        self.descriptors: dict[str, ParameterDescriptor] = {}
        self.pre_set: list[PreSet] = []
        self.on_set: list[OnSet] = []
        self.post_set: list[PostSet] = []
        self.publish_event: Callable[[ParameterEvent], None] = lambda event: None
        """Called with every change."""

    def declare(
        self, name: str, default: Any, given: ParameterDescriptor | None, ignore_override: bool
    ) -> Parameter:
        """Declares a parameter; raises as ``Node.declare_parameter`` does."""
        if name in self.values:
            raise ParameterAlreadyDeclaredException(name)
        if given is not None and not isinstance(given, ParameterDescriptor):
            raise TypeError(
                f"the descriptor of '{name}' must be a ParameterDescriptor, not {type(given).__name__}"
            )
        descriptor = ParameterDescriptor() if given is None else given.__deepcopy__(None)
        descriptor.name = name
        if isinstance(default, Parameter.Type):
            if default is NOT_SET:
                raise ValueError(f"Cannot declare parameter '{name}' of type NOT_SET")
            if descriptor.dynamic_typing:
                raise ValueError("a parameter declared by its type cannot be dynamically typed")
            descriptor.type = default.value
            default = None
        elif not descriptor.dynamic_typing:
            if default is None:
                descriptor.dynamic_typing = True
            else:
                descriptor.type = Parameter.Type.from_parameter_value(default).value
        override = None if ignore_override else self.overrides.get(name)
        parameter = override or Parameter(name, value=default)
        self.descriptors[name] = descriptor
        if parameter.type_ is NOT_SET:
            self.values[name] = parameter
            return parameter
        result = self.set([parameter], declaring=True)
        if not result.successful:
            del self.descriptors[name]
            if result.reason.startswith(_WRONG_TYPE):
                raise InvalidParameterTypeException(parameter, Parameter.Type(descriptor.type).name)
            raise InvalidParameterValueException(name, parameter.value, result.reason)
        return self.values[name]

    def check_known(self, parameters: list[Parameter]) -> None:
        """Checks that all are Parameters and declared. Raises TypeError, ParameterNotDeclaredException."""
        for parameter in parameters:
            if not isinstance(parameter, Parameter):
                raise TypeError(
                    f"set_parameters needs a list of Parameter('name', value=...), not {type(parameter).__name__}"
                )
        if not self.allow_undeclared:
            undeclared = [parameter.name for parameter in parameters if parameter.name not in self.values]
            if undeclared:
                self.must_be_declared(*undeclared)

    def set(self, parameters: list[Parameter], *, declaring: bool = False) -> SetParametersResult:
        """Sets all or none: checks descriptors, then callbacks; then publishes the event, and calls back."""
        for parameter in parameters:
            reason = self._descriptor_error(parameter, declaring=declaring)
            if reason:
                return SetParametersResult(successful=False, reason=reason)
        for callback in self.on_set:
            result = callback(parameters)
            if not isinstance(result, SetParametersResult):
                raise TypeError("a callback for parameters must return a SetParametersResult(successful=...)")
            if not result.successful:
                return result
        event = ParameterEvent()
        for parameter in parameters:
            self._store(parameter, event, declaring=declaring)
        self.publish_event(event)
        for after in self.post_set:
            after(parameters)
        return SetParametersResult(successful=True)

    def _store(self, parameter: Parameter, event: ParameterEvent, *, declaring: bool) -> None:
        name = parameter.name
        before = self.values.get(name)
        if parameter.type_ is NOT_SET:
            if before is not None:
                event.deleted_parameters.append(before.to_parameter_msg())
                del self.values[name], self.descriptors[name]
            return
        fresh = declaring or before is None or before.type_ is NOT_SET
        (event.new_parameters if fresh else event.changed_parameters).append(parameter.to_parameter_msg())
        self.values[name] = parameter
        self.descriptors.setdefault(name, ParameterDescriptor(name=name, dynamic_typing=True))
        if self.descriptors[name].dynamic_typing:
            self.descriptors[name].type = parameter.type_.value

    def _descriptor_error(self, parameter: Parameter, *, declaring: bool) -> str:
        """The reason why the descriptor forbids this value; empty if it allows it."""
        descriptor = self.descriptors.get(parameter.name)
        if descriptor is None:
            return ""
        if descriptor.read_only and not declaring:
            return "Trying to set a read-only parameter."
        if descriptor.dynamic_typing:
            return ""
        expected = Parameter.Type(descriptor.type)
        if parameter.type_ is NOT_SET:
            return "Static parameter cannot be undeclared"
        if not expected.check(parameter.value):
            return f"{_WRONG_TYPE}, expected '{expected.name}' got '{parameter.type_.name}'"
        if expected is Parameter.Type.INTEGER and descriptor.integer_range:
            limits = descriptor.integer_range[0]
            return _range_error(parameter.value, limits.from_value, limits.to_value, limits.step)
        if expected is Parameter.Type.DOUBLE and descriptor.floating_point_range:
            bounds = descriptor.floating_point_range[0]
            return _range_error(parameter.value, bounds.from_value, bounds.to_value, bounds.step)
        return ""

    def must_be_declared(self, *names: str) -> None:
        """Raises ParameterNotDeclaredException for undeclared names, with the most similar declared one."""
        missing = [name for name in names if name not in self.values]
        if missing:
            from kit.plain_text import nearest_name  # only a mistake needs it

            near = nearest_name(missing[0], self.values)
            raise ParameterNotDeclaredException(missing, near or "")


def _range_error(value: float, low: float, high: float, step: float) -> str:
    """The reason why a number is outside a range; empty if it is inside. Both ends are inside, whatever the step."""
    if value in (low, high):
        return ""
    if not low <= value <= high:
        return f"Parameter value {value} is out of range: {low} to {high}"
    off = (value - low) / step if step else 0.0
    if abs(off - round(off)) > 1e-9 * max(1.0, abs(off)):
        return f"Parameter value {value} is not a multiple of {step} above {low}"
    return ""
