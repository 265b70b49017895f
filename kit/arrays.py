"""Names for numpy arrays by the type of their items: Python's own number types, and numpy's names for the others."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

FloatArray: TypeAlias = NDArray[np.float64]
IntArray: TypeAlias = NDArray[np.int64]
BoolArray: TypeAlias = NDArray[np.bool_]
Float32Array: TypeAlias = NDArray[np.float32]
Uint8Array: TypeAlias = NDArray[np.uint8]
IndexArray: TypeAlias = NDArray[np.intp]
"""Places in other arrays, as numpy's own searches return them."""
