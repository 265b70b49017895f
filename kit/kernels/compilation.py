"""How kernels are compiled: on first use, called without working out types, or handed to C code."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

from kit.kernels.kernel_cache import SOURCE_STAMP, KernelCache
from kit.kernels.numba_import import UNTYPED, ccallback, numba, prepare_compiling

FunctionT = TypeVar("FunctionT", bound=Callable[..., Any])

_KEPT: list[Any] = []
"""C functions: their code lives as long as they do."""


def _compile_on_use(function: FunctionT, **options: bool) -> FunctionT:
    """Compiles on first use and remembers it on disk; where nothing may be written, compiles at each start."""
    njit: Any = numba.njit  # its types leave out options
    compiled = njit(error_model="numpy", **options)(function)
    try:
        # By itself numba looks at the function's own file alone, and not at those that it calls.
        compiled._cache = KernelCache(function, SOURCE_STAMP)
    except RuntimeError:  # neither beside this file nor in the user's cache
        prepare_compiling()
    return cast(FunctionT, compiled)


def jit(function: FunctionT) -> FunctionT:
    """Compiles a kernel when it is first used.

    A division by zero gives inf or nan, as in numpy: Python's check would keep loops from vectorising.
    ``fastmath`` stays off, for it gives other bits on other processors.
    """
    return _compile_on_use(function)


def jit_without_gil(function: FunctionT) -> FunctionT:
    """As ``jit``; other Python threads run meanwhile. For loops over many worlds: releasing the lock costs more than a
    short function takes."""
    return _compile_on_use(function, nogil=True)


def jit_borrowing(function: FunctionT) -> FunctionT:
    """As ``jit``, without counting references to arrays: inside loops that takes several times as long as what they do. Such
    a function allocates nothing and returns no array."""
    return _compile_on_use(function, _nrt=False)


def jit_borrowing_without_gil(function: FunctionT) -> FunctionT:
    """As ``jit_borrowing`` and ``jit_without_gil`` at once."""
    return _compile_on_use(function, nogil=True, _nrt=False)


def jit_inline(function: FunctionT) -> FunctionT:
    """Becomes a part of its callers: handing over arrays costs more than a short loop."""
    return cast(FunctionT, numba.njit(error_model="numpy", inline="always")(function))


def compiled_for(function: FunctionT, arguments: tuple[Any, ...]) -> FunctionT:
    """Returns the machine code of a kernel for arguments of just these types.

    Calling it spares working out the types of all arrays, which takes several microseconds a call. It checks nothing: later
    arguments must have the same types, dimensions and layout.
    """
    kernel: Any = function
    typeof: Any = numba.typeof
    types = tuple(map(typeof, arguments))
    kernel.compile(types)
    return cast(FunctionT, kernel.get_overload(types))


class TypedKernel:
    """A kernel that is always called with arguments of the same types, dimensions and layout; see ``compiled_for``."""

    def __init__(self, kernel: Callable[..., Any]) -> None:
        self._kernel = kernel
        self._code: Callable[..., Any] | None = None
        """For the types of the first call's arguments."""

    def __call__(self, *arguments: Any) -> Any:
        if self._code is None:
            self._code = compiled_for(self._kernel, arguments)
        return self._code(*arguments)

    def __getstate__(self) -> dict[str, Any]:
        """Machine code belongs to a process: a copy has its own at its first call."""
        return {"_kernel": self._kernel, "_code": None}


def c_function(function: Callable[..., Any], signature: str) -> int:
    """Returns the address of a function compiled for C code to call; ``signature``: in numba's words.

    A callback of a C library that is machine code spares the way into Python and back.
    """
    compiled: Any = ccallback.CFunc(
        function,
        UNTYPED.sigutils.normalize_signature(signature),
        locals={},
        options={"error_model": "numpy"},
    )
    try:
        compiled._cache = KernelCache(function)
    except RuntimeError:  # neither beside its file nor in the user's cache may be written
        prepare_compiling()
    compiled.compile()
    _KEPT.append(compiled)
    return int(compiled.address)
