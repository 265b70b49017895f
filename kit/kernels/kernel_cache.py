"""Where compiled kernels are kept on disk, and until when.

They hold until one of the files of this folder is edited. What the installation keeps for all accounts (``shared_cache``) is
read first, then an account's own, which it also writes; ``NUMBA_CACHE_DIR`` names one folder instead.
"""

from __future__ import annotations

import stat
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

from kit.kernels.numba_import import UNTYPED, caching, prepare_compiling, prepare_loading
from kit.kernels.shared_cache import unshared_reason

SOURCE_STAMP = tuple(
    (file.name, file.stat().st_mtime, file.stat().st_size)
    for file in sorted(Path(__file__).parent.glob("*.py"))
)
"""Changes when a file of kernels does."""


@cache
def _is_shared(folder: Path) -> bool:
    """Whether a folder holds kernels for all accounts: its hundred files are looked at once, not for each kernel."""
    return not unshared_reason(folder)


def _numba_locator(name: str) -> Any:
    """A class of numba's, which older versions call by a name with an underscore."""
    return getattr(caching, name, None) or getattr(caching, f"_{name}")


class _OwnersLocator(_numba_locator("InTreeCacheLocator")):  # type: ignore[misc]
    """Keeps kernels beside the source, unless everybody may write there: anyone could leave code for the others."""

    def ensure_cache_path(self) -> None:
        super().ensure_cache_path()
        if Path(self.get_cache_path()).stat().st_mode & stat.S_IWOTH:
            raise OSError("everybody may write there")


class _ReadOnlyLocator(_numba_locator("InTreeCacheLocator")):  # type: ignore[misc]
    """Reads the installation's kernels, for an account or a confined process that has no place of its own."""

    def ensure_cache_path(self) -> None:
        if not _is_shared(Path(self.get_cache_path())):
            raise OSError("no kernels for all accounts")


class _KernelCacheImpl(UNTYPED.caching.CompileResultCacheImpl):  # type: ignore[misc]
    _locator_classes = (
        _numba_locator("UserProvidedCacheLocator"),
        _OwnersLocator,
        _numba_locator("UserWideCacheLocator"),
        _ReadOnlyLocator,
    )


class _KernelFiles(UNTYPED.caching.IndexDataCacheFile):  # type: ignore[misc]
    """The files of one kernel, in both places."""

    def __init__(self, own: str, shared: Path, base: str, stamp: object) -> None:
        super().__init__(own, base, stamp)
        self._shared: Any = None
        if str(shared) != own and not UNTYPED.config.CACHE_DIR and _is_shared(shared):
            self._shared = UNTYPED.caching.IndexDataCacheFile(str(shared), base, stamp)

    def load(self, key: object) -> Any:
        with suppress(PermissionError):  # one that may not be read is compiled
            if self._shared is not None and (found := self._shared.load(key)) is not None:
                return found
            return super().load(key)
        return None

    def save(self, key: object, data: object) -> None:
        with suppress(PermissionError):  # only read: it is compiled at each start
            super().save(key, data)


class KernelCache(UNTYPED.caching.FunctionCache):  # type: ignore[misc]
    """The compiled forms of one kernel. Raises RuntimeError where there is no place for them."""

    _impl_class = _KernelCacheImpl

    def __init__(self, function: Callable[..., Any], stamp: object | None = None) -> None:
        """``stamp``: what must still be the same when they are read; by default the content of the function's file."""
        super().__init__(function)
        if stamp is None:
            stamp = self._impl.locator.get_source_stamp()
        shared = Path(function.__code__.co_filename).parent / "__pycache__"
        self._cache_file = _KernelFiles(self.cache_path, shared, self._impl.filename_base, stamp)

    def load_overload(self, sig: object, target_context: Any) -> Any:
        """As numba's, which gets ready to compile before it has looked: most drives find all their kernels here."""
        prepare_loading()
        with self._guard_against_spurious_io_errors():
            if (found := self._load_overload(sig, target_context)) is not None:
                return found
        prepare_compiling()
        return None
