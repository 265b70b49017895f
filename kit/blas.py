"""How numpy's OpenBLAS multiplies matrices: with which kernels, on how many threads.

By itself it takes the newest kernels that the processor has, and a thread for each core. Both change how sums are rounded:
the same training would learn otherwise on another machine. Only what is set before numpy is loaded counts.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cache
from typing import Final

KERNELS_VARIABLE: Final = "OPENBLAS_CORETYPE"
KERNELS: Final = "Haswell"
"""Those of x86-64 processors with AVX2 since 2013, of Intel's and AMD's."""
THREADS_VARIABLE: Final = "OPENBLAS_NUM_THREADS"
NEEDED: Final = frozenset({"avx2", "fma"})
"""What a processor must have to run them, as Linux names it."""
HEAD: Final = 16_384
"""Characters of the system's list of processors that hold the first one."""


@cache
def blas_environment() -> Mapping[str, str]:
    """The variables to set: one thread, and the kernels where the processor has them."""
    threads = {THREADS_VARIABLE: "1"}
    if os.uname().machine != "x86_64":
        return threads
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as opened:  # noqa: PTH123 - pathlib would take longer than all of this
            lines = opened.read(HEAD).splitlines()
    except OSError:
        return threads
    flags = next((line.partition(":")[2].split() for line in lines if line.startswith("flags")), [])
    return threads | ({KERNELS_VARIABLE: KERNELS} if frozenset(flags) >= NEEDED else {})


def prepare_blas() -> None:
    """Sets the variables for this process and those that it starts, unless the user has set them."""
    for name, value in blas_environment().items():
        os.environ.setdefault(name, value)
