"""Futures and tasks: results that are set later, and coroutines that await them."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Generator
from types import CoroutineType
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from kit.ros.execution.callback_groups import (
    NO_WORK,
    CallbackGroup,
    ItemOwner,
    ItemQueue,
    MutuallyExclusiveCallbackGroup,
    QueueOwner,
    ReadyItem,
)

if TYPE_CHECKING:
    from kit.ros.graph.ready_queue import ReadyQueue

T = TypeVar("T")


class Future(Generic[T]):
    """A result that is set later. Can be awaited in a coroutine callback."""

    def __init__(self, *, executor: QueueOwner | None = None) -> None:
        self._executor = executor
        self._handle: ItemOwner | None = None
        self._answering_group: CallbackGroup | None = None
        """The group of the callback that sets it, if one does."""
        self._lock = threading.Lock()
        self._done = False
        self._cancelled = False
        self._result: T | None = None
        self._exception: BaseException | None = None
        self._callbacks: list[Callable[[Future[T]], Any]] = []
        self._wakers: list[Callable[[], None]] = []

    def __await__(self) -> Generator[Future[T] | None, None, T | None]:
        while not self.done():
            # A loop of asyncio knows no futures but its own, and comes back at once.
            yield None if _is_in_asyncio() else self
        return self.result()

    def done(self) -> bool:
        """True if there is a result or an exception, or it was cancelled."""
        return self._done or self._cancelled

    def cancelled(self) -> bool:
        return self._cancelled

    def result(self) -> T | None:
        """The result; None while there is none. Raises the exception if one was set."""
        if self._exception is not None:
            raise self._exception
        return self._result

    def exception(self) -> BaseException | None:
        return self._exception

    def set_result(self, result: T) -> None:
        self._result = result
        self._finish()

    def set_exception(self, exception: BaseException) -> None:
        self._exception = exception
        self._finish()

    def cancel(self) -> None:
        """Cancels it and runs the done callbacks; no-op if it is done."""
        if not self._done:
            self._cancelled = True
            self._finish()

    def add_done_callback(self, callback: Callable[[Future[T]], Any]) -> None:
        """Calls ``callback(future)`` when it is done: in its executor, or at once if it has none."""
        with self._lock:
            if not self.done():
                self._callbacks.append(callback)
                return
        self._call(callback)

    def remove_done_callback(self, callback: Callable[[Future[T]], Any]) -> bool:
        """Removes a done callback; True if it was registered."""
        with self._lock:
            found = callback in self._callbacks
            self._callbacks = [other for other in self._callbacks if other != callback]
        return found

    def call_when_done(self, waker: Callable[[], None]) -> None:
        """Calls ``waker()`` as soon as it is done, in the thread that sets the result."""
        with self._lock:
            if not self.done():
                self._wakers.append(waker)
                return
        waker()

    def set_owner(self, handle: ItemOwner, group: CallbackGroup | None = None) -> None:
        """Runs the done callbacks where the callbacks of this node run. ``group``: that of the callback that will set it."""
        self._handle, self._answering_group = handle, group

    @property
    def _ready_queue(self) -> ItemQueue | None:
        if self._handle is not None:
            return self._handle.ready_queue
        return self._executor.ready_queue if self._executor is not None else None

    def _finish(self) -> None:
        with self._lock:
            self._done = not self._cancelled
            callbacks, self._callbacks = self._callbacks, []
            wakers, self._wakers = self._wakers, []
        for callback in callbacks:
            self._call(callback)
        for waker in wakers:
            waker()

    def _call(self, callback: Callable[[Future[T]], Any]) -> None:
        ready_queue = self._ready_queue
        if ready_queue is None:
            callback(self)
            return
        task: Task[Any] = Task(callback, (self,))
        task._handle, task._executor = self._handle, self._executor
        ready_queue.put(task)


class Task(Future[T]):
    """A function or coroutine in a ready queue, and its future result. ``executor.create_task`` makes one."""

    callback_group: CallbackGroup | None = None

    def __init__(
        self,
        handler: Any,
        args: tuple[Any, ...] | None = None,
        kwargs: dict[str, Any] | None = None,
        executor: QueueOwner | None = None,
    ) -> None:
        super().__init__(executor=executor)
        self._handler = handler
        self._args = args or ()
        self._kwargs = kwargs or {}
        self._coroutine: Any = handler if type(handler) is CoroutineType else None
        self._source: ReadyItem | None = None
        self._home_queue: ReadyQueue | None = None

    @property
    def handle(self) -> ItemOwner | None:
        return self._handle

    def continue_for(self, source: ReadyItem, ready_queue: ReadyQueue) -> None:
        """Makes this task the continuation of ``source``: the turn of ``source`` ends when the task is done."""
        self._source, self._handle, self._home_queue = source, source.handle, ready_queue

    def take(self) -> Any:
        return NO_WORK if self.done() else None

    def run(self, taken: Any) -> Any:
        self()

    def __call__(self) -> None:
        """Runs to the end, or to the next ``await`` of something that is not done."""
        if self.done():
            return
        try:
            if self._coroutine is None:
                result = self._handler(*self._args, **self._kwargs)
                if type(result) is not CoroutineType:
                    self._finish_source_turn()
                    self.set_result(result)
                    return
                self._coroutine = result
            awaited = self._coroutine.send(None)
        except StopIteration as end:
            self._finish_source_turn()
            self.set_result(end.value)
        except BaseException as problem:  # kept for whoever awaits the task, as asyncio does
            self._finish_source_turn()
            self.set_exception(problem)
            raise
        else:
            if isinstance(awaited, Future):
                self._warn_of_deadlock(awaited)
                awaited.call_when_done(self._resume)
            else:
                self._resume()

    def cancel(self) -> None:
        """Cancels the task; a waiting coroutine is closed."""
        if self._coroutine is not None and not self.done():
            self._coroutine.close()
            self._finish_source_turn()
        super().cancel()

    def _warn_of_deadlock(self, awaited: Future[Any]) -> None:
        """Warns where the answer that is awaited would have to run in the group that this callback keeps until it has it."""
        group, source = awaited._answering_group, self._source
        if (
            source is None
            or not isinstance(group, MutuallyExclusiveCallbackGroup)
            or group.active is not source
        ):
            return
        if self._handle is not None and not awaited.done():
            warning = (
                f"{source} awaits an answer that is handled in its own callback group, which is mutually exclusive: it waits "
                "forever. Give the client a callback group of its own: create_client(..., callback_group=...)"
            )
            self._handle.logger.warning(warning)

    def _resume(self) -> None:
        ready_queue = self._ready_queue or self._home_queue
        if ready_queue is not None:
            ready_queue.put(self)

    def _finish_source_turn(self) -> None:
        """Ends the turn that this task continues."""
        source, self._source = self._source, None
        if source is not None and self._home_queue is not None:
            self._home_queue.finish(source)


def _is_in_asyncio() -> bool:
    """True if a loop of asyncio is running in this thread."""
    asyncio = sys.modules.get("asyncio")
    return asyncio is not None and asyncio._get_running_loop() is not None


async def await_or_execute(callback: Callable[..., Any], *args: Any) -> Any:
    """The result of ``callback(*args)``; awaits it if the callback is a coroutine function."""
    result = callback(*args)
    return await result if type(result) is CoroutineType else result
