"""How kernels are compiled: on first use, kept on disk, called without working out types, or handed to C code.

What numba keeps on disk holds until one of the files of this folder is edited. What the installation keeps for all accounts
(``shared_cache``) is read first, then an account's own, which it also writes; ``NUMBA_CACHE_DIR`` names one folder instead.
"""

from __future__ import annotations

import os
import stat
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import chdir, contextmanager, nullcontext, suppress
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

from kit.kernels.compilation_progress import PROGRESS
from kit.kernels.shared_cache import unshared_reason

NUMBA_SETTINGS = Path(".numba_config.yaml")
"""numba reads it in the current folder, at its import and whenever it compiles. It names the cache, whose files can run code,
and the current folder may be a student's."""
UNUSED = ("scipy", "cffi")
"""What numba would import for linear algebra and for C functions that cffi declares, of which kernels have neither: with all that
these import, they take 14 MB of every drive (``tests/benchmarks/memory.py``)."""


@contextmanager
def _hide_packages(names: Sequence[str]) -> Iterator[None]:
    """Has packages be as if they were not installed, unless they are imported already."""
    hidden = [name for name in names if name not in sys.modules]
    sys.modules.update(dict.fromkeys(hidden))  # type: ignore[arg-type] # None is Python's own mark for it
    try:
        yield
    finally:
        for name in hidden:
            sys.modules.pop(name, None)


# Not compiled, kernels take a hundred times as long, and what a budget of time allows depends on the caller's environment.
os.environ.pop("NUMBA_DISABLE_JIT", None)
with _hide_packages(UNUSED), chdir("/") if NUMBA_SETTINGS.exists() else nullcontext():
    import numba
    from numba.core import caching, ccallback, config, event
    from numba.core.registry import cpu_target

    cpu_target.target_context.refresh()  # imports the rest, which the first kernel would do

config._config_fname = ""  # no file has this name


class _ProgressListener(event.Listener):
    def on_start(self, event: Any) -> None:
        PROGRESS.begin(event.data["dispatcher"].py_func.__name__)

    def on_end(self, event: Any) -> None:
        PROGRESS.end()


_register: Any = event.register  # numba has no types
_register("numba:compile", _ProgressListener())

SOURCE_STAMP = tuple(
    (file.name, file.stat().st_mtime, file.stat().st_size)
    for file in sorted(Path(__file__).parent.glob("*.py"))
)
"""Changes when a file of kernels does."""


_UNTYPED: Any = numba.core
"""numba's own modules, which have no types."""


@cache
def _is_shared(folder: Path) -> bool:
    """Whether a folder holds kernels for all accounts: its hundred files are looked at once, not for each kernel."""
    return not unshared_reason(folder)


def _numba_locator(name: str) -> Any:
    """A class of numba's, which older versions call by a name with an underscore."""
    return getattr(caching, name, None) or getattr(caching, f"_{name}")


class _OwnersLocator(_numba_locator("InTreeCacheLocator")):  # type: ignore[misc]
    """Beside the source, unless everybody may write there: anyone could leave code for the others."""

    def ensure_cache_path(self) -> None:
        super().ensure_cache_path()
        if Path(self.get_cache_path()).stat().st_mode & stat.S_IWOTH:
            raise OSError("everybody may write there")


class _ReadOnlyLocator(_numba_locator("InTreeCacheLocator")):  # type: ignore[misc]
    """For an account, or a confined process, that has no place of its own: it reads the installation's."""

    def ensure_cache_path(self) -> None:
        if not _is_shared(Path(self.get_cache_path())):
            raise OSError("no kernels for all accounts")


class _KernelCacheImpl(_UNTYPED.caching.CompileResultCacheImpl):  # type: ignore[misc]
    _locator_classes = (
        _numba_locator("UserProvidedCacheLocator"),
        _OwnersLocator,
        _numba_locator("UserWideCacheLocator"),
        _ReadOnlyLocator,
    )


class _KernelFiles(_UNTYPED.caching.IndexDataCacheFile):  # type: ignore[misc]
    """The files of one kernel, in both places."""

    def __init__(self, own: str, shared: Path, base: str, stamp: object) -> None:
        super().__init__(own, base, stamp)
        self._shared: Any = None
        if str(shared) != own and not _UNTYPED.config.CACHE_DIR and _is_shared(shared):
            self._shared = _UNTYPED.caching.IndexDataCacheFile(str(shared), base, stamp)

    def load(self, key: object) -> Any:
        with suppress(PermissionError):  # one that may not be read is compiled
            if self._shared is not None and (found := self._shared.load(key)) is not None:
                return found
            return super().load(key)
        return None

    def save(self, key: object, data: object) -> None:
        with suppress(PermissionError):  # only read: it is compiled at each start
            super().save(key, data)


class KernelCache(_UNTYPED.caching.FunctionCache):  # type: ignore[misc]
    """The compiled forms of one kernel. Raises RuntimeError where there is no place for them."""

    _impl_class = _KernelCacheImpl

    def __init__(self, function: Callable[..., Any], stamp: object | None = None) -> None:
        """``stamp``: what must still be the same when they are read; by default the content of the function's file."""
        super().__init__(function)
        if stamp is None:
            stamp = self._impl.locator.get_source_stamp()
        shared = Path(function.__code__.co_filename).parent / "__pycache__"
        self._cache_file = _KernelFiles(self.cache_path, shared, self._impl.filename_base, stamp)


FunctionT = TypeVar("FunctionT", bound=Callable[..., Any])


def _compile_on_use(function: FunctionT, **options: bool) -> FunctionT:
    """Compiles on first use and remembers it on disk; where nothing may be written, compiles at each start."""
    njit: Any = numba.njit  # its types leave out options
    compiled = njit(error_model="numpy", **options)(function)
    with suppress(RuntimeError):  # neither beside this file nor in the user's cache
        # By itself numba looks at the function's own file alone, and not at those that it calls.
        compiled._cache = KernelCache(function, SOURCE_STAMP)
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
        _UNTYPED.sigutils.normalize_signature(signature),
        locals={},
        options={"error_model": "numpy"},
    )
    with suppress(RuntimeError):  # neither beside its file nor in the user's cache may be written
        compiled._cache = KernelCache(function)
    compiled.compile()
    _KEPT.append(compiled)
    return int(compiled.address)


_KEPT: list[Any] = []
"""C functions: their code lives as long as they do."""
