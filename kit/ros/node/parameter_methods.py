"""The methods of a node that concern its parameters."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from kit.msg.rcl_interfaces import (
    ListParametersResult,
    ParameterDescriptor,
    ParameterValue,
    SetParametersResult,
)
from kit.msg.rcl_interfaces import Parameter as ParameterMessage
from kit.ros.exceptions import (
    InvalidParameterValueException,
    ParameterImmutableException,
    ParameterUninitializedException,
)
from kit.ros.graph.naming import validate_parameter_name
from kit.ros.parameters.parameter import PARAMETER_SEPARATOR_STRING, Parameter
from kit.ros.parameters.parameter_store import NOT_SET, OnSet, PostSet, PreSet

if TYPE_CHECKING:
    from kit.ros.node.node_handle import NodeHandle

_EMPTIED = "parameter list cannot be empty: a pre_set_parameters_callback returned no parameter"


class NodeParameterMethods:
    """A part of Node."""

    if TYPE_CHECKING:

        @property
        def handle(self) -> NodeHandle: ...

    def declare_parameter(
        self,
        name: str,
        value: Any = None,
        descriptor: ParameterDescriptor | None = None,
        ignore_override: bool = False,
    ) -> Parameter:
        """Announces a parameter with its default, or with its ``Parameter.Type`` only.

        A value given on the command line, in a file or to the node takes the default's place. Raises
        ParameterAlreadyDeclaredException, InvalidParameterException, InvalidParameterTypeException if that value
        has another type, InvalidParameterValueException if it is out of range or a callback refuses it.
        """
        return self.declare_parameters("", [(name, value, descriptor)], ignore_override)[0]

    def declare_parameters(
        self, namespace: str, parameters: Iterable[tuple[Any, ...]], ignore_override: bool = False
    ) -> list[Parameter]:
        """Announces ``(name[, default[, descriptor]])``, all under ``namespace.``"""
        declared = []
        for index, entry in enumerate(parameters):
            if not isinstance(entry, tuple) or not 1 <= len(entry) <= 3:
                raise TypeError(
                    f"Invalid parameter at index {index}: {entry!r} is not (name,), (name, value) or "
                    "(name, value, descriptor)"
                )
            name, default, descriptor = (*entry, None, None)[:3]
            validate_parameter_name(name)
            full = f"{namespace}{PARAMETER_SEPARATOR_STRING}{name}" if namespace else name
            declared.append(self.handle.parameters.declare(full, default, descriptor, ignore_override))
        return declared

    def undeclare_parameter(self, name: str) -> None:
        """Forgets a parameter. Raises ParameterNotDeclaredException, ParameterImmutableException."""
        store = self.handle.parameters
        store.must_be_declared(name)
        if store.descriptors[name].read_only:
            raise ParameterImmutableException(name)
        del store.values[name], store.descriptors[name]

    def has_parameter(self, name: str) -> bool:
        return name in self.handle.parameters.values

    def get_parameter(self, name: str) -> Parameter:
        """Raises ParameterNotDeclaredException; ParameterUninitializedException for a type without a value."""
        store = self.handle.parameters
        if name not in store.values and store.allow_undeclared:
            return Parameter(name)
        store.must_be_declared(name)
        parameter = store.values[name]
        if parameter.type_ is NOT_SET and not store.descriptors[name].dynamic_typing:
            raise ParameterUninitializedException(name)
        return parameter

    def get_parameters(self, names: Sequence[str]) -> list[Parameter]:
        """Calls ``get_parameter`` for each name."""
        if isinstance(names, str):
            raise TypeError("get_parameters needs a list of names; for one name there is get_parameter")
        return [self.get_parameter(name) for name in names]

    def get_parameter_or(self, name: str, alternative_value: Parameter | None = None) -> Parameter:
        """The parameter, or the alternative if it is not declared or has no value."""
        found = self.handle.parameters.values.get(name)
        if found is not None and found.type_ is not NOT_SET:
            return found
        return Parameter(name) if alternative_value is None else alternative_value

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter]:
        """The parameters ``prefix.x``, as ``x``."""
        start = f"{prefix}{PARAMETER_SEPARATOR_STRING}" if prefix else ""
        found = self.handle.parameters.values.items()
        return {name[len(start) :]: parameter for name, parameter in found if name.startswith(start)}

    def get_parameter_type(self, name: str) -> Parameter.Type:
        return self.get_parameter(name).type_

    def get_parameter_types(self, names: Sequence[str]) -> list[Parameter.Type]:
        return [self.get_parameter_type(name) for name in names]

    def list_parameters(self, prefixes: Sequence[str], depth: int) -> ListParametersResult:
        """Names under the prefixes, at most ``depth`` parts below them; depth 0: all."""
        names: list[str] = []
        groups: list[str] = []
        for name in self.handle.parameters.values:
            if any(_is_below(name, prefix, depth) for prefix in prefixes or [""]):
                names.append(name)
                group = name.rpartition(PARAMETER_SEPARATOR_STRING)[0]
                if group and group not in groups:
                    groups.append(group)
        return ListParametersResult(names=names, prefixes=groups)

    def set_parameters(self, parameter_list: list[Parameter]) -> list[SetParametersResult]:
        """Sets one after the other, each with what the pre-set callbacks add to it; a result says whether, or why not.

        Raises ParameterNotDeclaredException; what stands before that parameter stays set.
        """
        return [self.set_parameters_atomically([parameter]) for parameter in parameter_list]

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> SetParametersResult:
        """Sets all or none. Raises ParameterNotDeclaredException."""
        store = self.handle.parameters
        for callback in store.pre_set:
            parameter_list = callback(parameter_list)
        if store.pre_set and not parameter_list:
            return SetParametersResult(successful=False, reason=_EMPTIED)
        store.check_known(parameter_list)
        return store.set(parameter_list)

    def describe_parameter(self, name: str) -> ParameterDescriptor:
        """Raises ParameterNotDeclaredException."""
        store = self.handle.parameters
        if name not in store.descriptors and store.allow_undeclared:
            return ParameterDescriptor()
        store.must_be_declared(name)
        return store.descriptors[name]

    def describe_parameters(self, names: Sequence[str]) -> list[ParameterDescriptor]:
        """Calls ``describe_parameter`` for each name."""
        return [self.describe_parameter(name) for name in names]

    def set_descriptor(
        self, name: str, descriptor: ParameterDescriptor, alternative_value: ParameterValue | None = None
    ) -> ParameterValue:
        """Replaces the descriptor and, if a value is given, the value; returns the value then held.

        Raises ParameterNotDeclaredException, ParameterImmutableException, InvalidParameterValueException.
        """
        store = self.handle.parameters
        store.must_be_declared(name)
        before = store.descriptors[name]
        if before.read_only:
            raise ParameterImmutableException(name)
        parameter = store.values[name]
        if alternative_value is not None:
            parameter = Parameter.from_parameter_msg(ParameterMessage(name=name, value=alternative_value))
        new = descriptor.__deepcopy__(None)
        new.name = name
        if not new.dynamic_typing:
            new.type = parameter.type_.value
        store.descriptors[name] = new
        result = store.set([parameter], declaring=True)
        if not result.successful:
            store.descriptors[name] = before
            raise InvalidParameterValueException(name, parameter.value, result.reason)
        return store.values[name].get_parameter_value()

    def add_pre_set_parameters_callback(self, callback: PreSet) -> None:
        """``callback(parameters)`` may change the list before anything is checked."""
        self.handle.parameters.pre_set.insert(0, callback)

    def add_on_set_parameters_callback(self, callback: OnSet) -> None:
        """``callback(parameters)`` returns a SetParametersResult, which may reject the change."""
        self.handle.parameters.on_set.insert(0, callback)

    def add_post_set_parameters_callback(self, callback: PostSet) -> None:
        """``callback(parameters)`` is called after they have been set."""
        self.handle.parameters.post_set.insert(0, callback)

    def remove_pre_set_parameters_callback(self, callback: PreSet) -> None:
        self.handle.parameters.pre_set.remove(callback)

    def remove_on_set_parameters_callback(self, callback: OnSet) -> None:
        self.handle.parameters.on_set.remove(callback)

    def remove_post_set_parameters_callback(self, callback: PostSet) -> None:
        self.handle.parameters.post_set.remove(callback)


def _is_below(name: str, prefix: str, depth: int) -> bool:
    """True if a parameter is the prefix itself, or at most ``depth`` parts below it."""
    start = f"{prefix}{PARAMETER_SEPARATOR_STRING}" if prefix else ""
    if name == prefix:
        return True
    return name.startswith(start) and (
        depth == 0 or name[len(start) :].count(PARAMETER_SEPARATOR_STRING) < depth
    )
