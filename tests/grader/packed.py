"""Files of several parts, as bytes."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping
from typing import Any

import numpy as np


def zipped(entries: Mapping[str, bytes]) -> bytes:
    """A zip file with these entries."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in entries.items():
            archive.writestr(name, content)
    return packed.getvalue()


def array_bytes(array: Any) -> bytes:
    """A .npy file with this array."""
    packed = io.BytesIO()
    np.save(packed, array)
    return packed.getvalue()
