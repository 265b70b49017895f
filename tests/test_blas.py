"""Products of matrices are the same to the bit on every x86-64 processor with AVX2, whatever newer kernels it has, and on
any number of cores."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from kit.blas import KERNELS, KERNELS_VARIABLE, THREADS_VARIABLE, blas_environment

PRODUCT = """
import hashlib, os
{first}
import numpy as np
random = np.random.default_rng(0)
sizes = (32, 17, 24), (32, 38, 24), (300, 64, 64)
products = [random.normal(size=(n, m)).astype("f4") @ random.normal(size=(m, k)).astype("f4") for n, m, k in sizes]
print(hashlib.sha256(b"".join(each.tobytes() for each in products)).hexdigest())
"""


def product(first: str, **variables: str) -> str:
    """``first``: what is run before numpy is imported."""
    unset = {KERNELS_VARIABLE, THREADS_VARIABLE}
    environment = {name: value for name, value in os.environ.items() if name not in unset}
    return subprocess.run(
        [sys.executable, "-c", PRODUCT.format(first=first)],
        env=environment | variables,
        capture_output=True,
        text=True,
        check=True,
    ).stdout


@pytest.mark.skipif(KERNELS_VARIABLE not in blas_environment(), reason="this processor has not the kernels")
def test_the_kit_multiplies_with_one_kind_of_kernel_on_one_thread() -> None:
    assert product("import kit") == product("", **{KERNELS_VARIABLE: KERNELS, THREADS_VARIABLE: "1"})


def test_one_core_gives_what_many_give() -> None:
    assert product("import kit") == product(
        "os.sched_setaffinity(0, {min(os.sched_getaffinity(0))}); import kit"
    )


@pytest.mark.parametrize(("variable", "value"), [(KERNELS_VARIABLE, "Prescott"), (THREADS_VARIABLE, "2")])
def test_who_has_chosen_otherwise_keeps_it(variable: str, value: str) -> None:
    chosen = subprocess.run(
        [sys.executable, "-c", f"import kit, os; print(os.environ[{variable!r}])"],
        env=os.environ | {variable: value},
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    assert chosen == f"{value}\n"
