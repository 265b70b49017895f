"""What a lifecycle node manages: entities that follow its transitions, such as publishers that are silent until
it is active."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar

from kit.msg.message import Message
from kit.ros.lifecycle.state_machine import LifecycleState, TransitionCallbackReturn
from kit.ros.node.publisher import Publisher

M = TypeVar("M", bound=Message)


class ManagedEntity:
    """Something with a callback for each transition of its node; by default each says SUCCESS."""

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS


class SimpleManagedEntity(ManagedEntity):
    """An entity that is enabled while its node is active."""

    def __init__(self) -> None:
        self._enabled = False

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        self._enabled = True
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        self._enabled = False
        return TransitionCallbackReturn.SUCCESS

    @property
    def is_activated(self) -> bool:
        return self._enabled

    @staticmethod
    def when_enabled(
        wrapped: Callable[..., None] | None = None, *, when_not_enabled: Callable[[], Any] | None = None
    ) -> Any:
        """Decorator of a method that does nothing, or calls ``when_not_enabled()``, while it is not enabled."""

        def decorate(method: Callable[..., None]) -> Callable[..., None]:
            @wraps(method)
            def call_when_enabled(self: SimpleManagedEntity, *arguments: Any, **options: Any) -> None:
                if self._enabled:
                    method(self, *arguments, **options)
                elif when_not_enabled is not None:
                    when_not_enabled()

            return call_when_enabled

        return decorate if wrapped is None else decorate(wrapped)


class LifecyclePublisher(SimpleManagedEntity, Publisher[M]):
    """A publisher whose messages are dropped while its node is not active."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        SimpleManagedEntity.__init__(self)
        Publisher.__init__(self, *arguments, **options)
        self._has_warned = False

    def publish(self, msg: M | bytes) -> None:
        """Publishes a message, if the node is active; otherwise says once, after each change, that it is not."""
        if self._enabled:
            self._has_warned = False
            super().publish(msg)
        elif not self._has_warned:
            self._has_warned = True
            warning = f"Trying to publish message on the topic '{self.topic_name}', but the publisher is not activated"
            self.handle.logger.warning(warning)
