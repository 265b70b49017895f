"""QoS overrides: parameters of a node by which its users change the QoS of its publishers and subscriptions."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, Final, Literal, Self

from kit.msg.rcl_interfaces import ParameterDescriptor, SetParametersResult
from kit.ros.exceptions import ParameterAlreadyDeclaredException
from kit.ros.node.qos import QoSPolicyEnum, QoSPolicyKind, QoSProfile
from kit.ros.node.time import Duration

if TYPE_CHECKING:
    from kit.ros.node.parameter_methods import NodeParameterMethods

QosCallbackResult = SetParametersResult
"""The result of a callback that checks a profile: ``QosCallbackResult(successful=True)``."""

QosCallbackType = Callable[[QoSProfile], QosCallbackResult]


class InvalidQosOverridesError(Exception):
    """The callback of the options has refused the profile."""


class QoSOverridingOptions:
    """The policies of a publisher or subscription that parameters may override.

    ``callback(profile)`` checks the result. ``entity_id`` tells apart several of one node on one topic.
    """

    def __init__(
        self,
        policy_kinds: Iterable[QoSPolicyKind],
        *,
        callback: QosCallbackType | None = None,
        entity_id: str | None = None,
    ) -> None:
        self._policy_kinds = tuple(policy_kinds)
        self._callback = callback
        self._entity_id = entity_id

    @classmethod
    def with_default_policies(
        cls, *, callback: QosCallbackType | None = None, entity_id: str | None = None
    ) -> Self:
        """History, depth and reliability may be overridden."""
        kinds = (QoSPolicyKind.HISTORY, QoSPolicyKind.DEPTH, QoSPolicyKind.RELIABILITY)
        return cls(kinds, callback=callback, entity_id=entity_id)

    @property
    def policy_kinds(self) -> Iterable[QoSPolicyKind]:
        return self._policy_kinds

    @property
    def callback(self) -> QosCallbackType | None:
        return self._callback

    @property
    def entity_id(self) -> str | None:
        return self._entity_id


EndpointKind = Literal["publisher", "subscription"]

_NOT_A_SUBSCRIPTIONS: Final = frozenset({QoSPolicyKind.LIFESPAN})


def declare_qos_parameters(
    kind: EndpointKind,
    node: NodeParameterMethods,
    topic_name: str,
    profile: QoSProfile,
    options: QoSOverridingOptions,
) -> QoSProfile:
    """Declares ``qos_overrides./topic.publisher.depth`` and the like; returns the profile with their values.

    Raises InvalidQosOverridesError if the callback refuses it, RuntimeError for a value that a policy does not have.
    """
    suffix = "" if options.entity_id is None else f"_{options.entity_id}"
    of_whom = f"for {kind} `{topic_name}` with id `{options.entity_id}`"
    overridden = profile.copy()
    for policy in options.policy_kinds:
        if policy is QoSPolicyKind.INVALID or (kind == "subscription" and policy in _NOT_A_SUBSCRIPTIONS):
            continue
        setting = policy.name.lower()
        name = f"qos_overrides.{topic_name}.{kind}{suffix}.{setting}"
        descriptor = ParameterDescriptor(description=f"{setting} {of_whom}", read_only=True)
        try:
            parameter = node.declare_parameter(
                name, _as_parameter_value(getattr(profile, setting)), descriptor
            )
        except ParameterAlreadyDeclaredException:
            parameter = node.get_parameter(name)
        _override(overridden, setting, parameter.value)
    if options.callback is not None:
        result = options.callback(overridden)
        if not result.successful:
            raise InvalidQosOverridesError(
                f"Provided QoS overrides {of_whom}, are not valid: {result.reason}"
            )
    return overridden


def _as_parameter_value(setting: Any) -> bool | int | str:
    """A policy's setting as parameters hold it: durations in nanoseconds, names in lower case."""
    if isinstance(setting, Duration):
        return setting.nanoseconds
    if isinstance(setting, QoSPolicyEnum):
        return setting.short_key
    number: bool | int = setting
    return number


def _override(profile: QoSProfile, name: str, value: Any) -> None:
    before = getattr(profile, name)
    if isinstance(before, Duration):
        value = Duration(nanoseconds=value)
    elif isinstance(before, QoSPolicyEnum):
        try:
            value = type(before).get_from_short_key(value)
        except KeyError:
            known = ", ".join(type(before).short_keys())
            raise RuntimeError(
                f"Unexpected QoS override for policy `{name}`: `{value}`; available: {known}"
            ) from None
    setattr(profile, name, value)
