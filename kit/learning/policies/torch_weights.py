"""Reads the tensors that ``torch.save`` wrote of a module's ``state_dict``, without torch, and never more than is stored.

Such a file is an archive of numbers and of one pickle, which says which tensor is made of which numbers. The pickle is not
loaded: it is read operation by operation, and nothing can be made of it but names, numbers and tensors. Nor is it given to
``torch.load``, which with ``weights_only`` runs no program, but takes whatever memory a hostile pickle asks for.
"""

from __future__ import annotations

import io
import math
import pickletools
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Final

import numpy as np
from numpy.lib.stride_tricks import as_strided
from numpy.typing import NDArray

from kit.array_archives import MAX_UNPACKED_BYTES, check_stored
from kit.arrays import Float32Array

STORAGE_TYPES: Final = MappingProxyType(
    {
        "torch FloatStorage": "f4", "torch DoubleStorage": "f8", "torch HalfStorage": "f2",
        "torch LongStorage": "i8", "torch IntStorage": "i4", "torch ShortStorage": "i2", "torch CharStorage": "i1",
        "torch ByteStorage": "u1", "torch BoolStorage": "?",
    }
)  # fmt: skip
"""numpy's types of what torch stores, without the order of bytes."""
MAX_DIMENSIONS: Final = 8
MAX_PICKLE_BYTES: Final = 1 << 20
MAX_OPERATIONS: Final = 100_000
"""Of the pickle; a tensor takes about thirty."""

_NUMBERS: Final = frozenset({"BININT", "BININT1", "BININT2", "LONG1", "BINFLOAT", "BINUNICODE"})
_CONSTANTS: Final = MappingProxyType({"NONE": None, "NEWTRUE": True, "NEWFALSE": False, "EMPTY_TUPLE": ()})
_TUPLES: Final = MappingProxyType({"TUPLE1": 1, "TUPLE2": 2, "TUPLE3": 3})
_MARK: Final = object()


@dataclass(frozen=True, slots=True)
class _Name:
    """The name of a function or class in the pickle, which is never imported."""

    name: str


@dataclass(frozen=True, slots=True)
class _Storage:
    """Numbers in the archive."""

    key: str
    type_name: str


@dataclass(frozen=True, slots=True)
class _Tensor:
    """A view of numbers in the archive."""

    storage: _Storage
    offset: int
    shape: tuple[int, ...]
    strides: tuple[int, ...]
    """In numbers."""


def read_torch_weights(packed: bytes) -> Mapping[str, Float32Array]:
    """Returns the tensors of a file of ``torch.save`` by name, as numbers of 4 bytes.

    Raises ValueError, KeyError and zipfile.BadZipFile for what is damaged, larger than its file, or not tensors by name.
    """
    with zipfile.ZipFile(io.BytesIO(packed)) as archive:
        check_stored(archive, len(packed))
        root = next(
            (name.removesuffix("data.pkl") for name in archive.namelist() if name.endswith("/data.pkl")), ""
        )
        pickled = archive.read(f"{root}data.pkl")
        order = (
            ">"
            if f"{root}byteorder" in archive.namelist() and archive.read(f"{root}byteorder") == b"big"
            else "<"
        )
        if len(pickled) > MAX_PICKLE_BYTES:
            raise ValueError(f"its list of tensors is larger than {MAX_PICKLE_BYTES >> 20} MiB")
        tensors = _named_tensors(pickled)
        if 4 * sum(math.prod(tensor.shape) for tensor in tensors.values()) > MAX_UNPACKED_BYTES:
            raise ValueError(f"its tensors are larger than {MAX_UNPACKED_BYTES >> 20} MiB")
        # Each once: thousands of tensors may be views of the same numbers.
        keys = {tensor.storage.key for tensor in tensors.values()}
        stored = {key: archive.read(f"{root}data/{key}") for key in keys}
    return {name: _array_of(tensor, stored[tensor.storage.key], order) for name, tensor in tensors.items()}


def _array_of(tensor: _Tensor, numbers: bytes, order: str) -> Float32Array:
    kind = STORAGE_TYPES.get(tensor.storage.type_name)
    if kind is None:
        raise ValueError(f"numbers of the type {tensor.storage.type_name[:60]}")
    stored: NDArray[Any] = np.frombuffer(numbers, np.dtype(order + kind))
    count = math.prod(tensor.shape)
    last = tensor.offset + sum((n - 1) * step for n, step in zip(tensor.shape, tensor.strides, strict=True))
    if count > len(stored) or (count and last >= len(stored)):
        raise ValueError("a tensor of more numbers than are stored")
    view = as_strided(
        stored[tensor.offset :] if count else stored[:0],
        tensor.shape,
        tuple(step * stored.itemsize for step in tensor.strides),
        writeable=False,
    )
    with np.errstate(over="ignore"):  # becomes infinite, which no policy may be
        return np.array(view, dtype=np.float32)


def _named_tensors(pickled: bytes) -> dict[str, _Tensor]:
    """What the pickle of a ``state_dict`` says, by the operations that ``torch.save`` writes."""
    stack: list[Any] = []
    memo: dict[int, Any] = {}
    try:
        for number, (operation, value, _) in enumerate(pickletools.genops(pickled)):
            if number == MAX_OPERATIONS:
                raise ValueError("its list of tensors is too long")
            _do(operation.name, value, stack, memo)
    except (IndexError, TypeError, UnicodeDecodeError):
        raise ValueError("its list of tensors is damaged") from None
    if len(stack) != 1 or not isinstance(stack[0], dict):
        raise ValueError("it holds no weights by name")
    return {name: value for name, value in stack[0].items() if isinstance(value, _Tensor)}


def _do(operation: str, value: Any, stack: list[Any], memo: dict[int, Any]) -> None:
    """Does one operation of a pickle. Raises ValueError for one that no tensor needs."""
    if operation in _NUMBERS:
        stack.append(value)
    elif operation in _CONSTANTS:
        stack.append(_CONSTANTS[operation])
    elif operation in ("BINPUT", "LONG_BINPUT"):
        memo[value] = stack[-1]
    elif operation in ("BINGET", "LONG_BINGET"):
        stack.append(memo[value])
    elif operation == "GLOBAL":
        stack.append(_Name(value))
    elif operation == "MARK":
        stack.append(_MARK)
    elif operation == "EMPTY_DICT":
        stack.append({})
    elif operation in _TUPLES:
        stack.append(tuple(_pop(stack) for _ in range(_TUPLES[operation]))[::-1])
    elif operation == "TUPLE":
        stack.append(tuple(_pop_marked(stack)))
    elif operation == "BINPERSID":
        stack.append(_storage(_pop(stack)))
    elif operation == "REDUCE":
        given = _pop(stack)
        stack.append(_construct(_pop(stack), given))
    elif operation == "SETITEM":
        last = _pop(stack)
        _set_items(stack, [_pop(stack), last])
    elif operation == "SETITEMS":
        _set_items(stack, _pop_marked(stack))
    elif operation == "BUILD":  # what a state_dict says of versions of its modules
        _pop(stack)
    elif operation not in ("PROTO", "STOP"):
        raise ValueError(f"its list of tensors does {operation}, which no tensor needs")


def _pop(stack: list[Any]) -> Any:
    value = stack.pop()
    if value is _MARK:
        raise ValueError("its list of tensors is damaged")
    return value


def _pop_marked(stack: list[Any]) -> list[Any]:
    """All that stands behind the last mark."""
    values = []
    while (value := stack.pop()) is not _MARK:
        values.append(value)
    return values[::-1]


def _set_items(stack: list[Any], items: list[Any]) -> None:
    target, names = stack[-1], items[::2]
    # A nested tuple would be hashed, to a depth that ends the process.
    if not isinstance(target, dict) or len(items) % 2 or not all(isinstance(name, str) for name in names):
        raise ValueError("it holds no weights by name")
    target.update(zip(names, items[1::2], strict=True))


def _construct(function: Any, given: Any) -> Any:
    """What the pickle says that a function returned: a dictionary, or a tensor."""
    name = function.name if isinstance(function, _Name) else "something unnamed"
    if name == "collections OrderedDict" and given == ():
        return {}
    if name == "torch._utils _rebuild_parameter" and isinstance(given[0], _Tensor):
        return given[0]
    if name != "torch._utils _rebuild_tensor_v2":
        raise ValueError(f"{name[:60]} is no tensor")
    storage, offset, shape, strides = given[:4]
    numbers = (offset, *shape, *strides)
    if (
        not isinstance(storage, _Storage)
        or len(shape) != len(strides)
        or len(shape) > MAX_DIMENSIONS
        or not all(type(number) is int and 0 <= number <= MAX_UNPACKED_BYTES for number in numbers)
    ):
        raise ValueError("a tensor that is none")
    return _Tensor(storage, offset, shape, strides)


def _storage(given: Any) -> _Storage:
    word, kind, key = given[:3]
    if word != "storage" or not isinstance(kind, _Name) or not isinstance(key, str):
        raise ValueError("a tensor without numbers")
    return _Storage(key, kind.name)
