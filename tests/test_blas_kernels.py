"""Products of matrices are the same to the bit on every x86-64 processor with AVX2, whatever newer kernels it has."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from kit.blas_kernels import KERNELS, VARIABLE, blas_environment

PRODUCT = """
import hashlib
{first}
import numpy as np
random = np.random.default_rng(0)
products = [random.normal(size=(32, n)).astype("f4") @ random.normal(size=(n, 24)).astype("f4") for n in (17, 24, 38)]
print(hashlib.sha256(b"".join(each.tobytes() for each in products)).hexdigest())
"""


def product(first: str, **variables: str) -> str:
    environment = {name: value for name, value in os.environ.items() if name != VARIABLE}
    return subprocess.run(
        [sys.executable, "-c", PRODUCT.format(first=first)],
        env=environment | variables,
        capture_output=True,
        text=True,
        check=True,
    ).stdout


@pytest.mark.skipif(not blas_environment(), reason="this processor has not the kernels")
def test_the_kit_multiplies_with_one_kind_of_kernel() -> None:
    assert product("import kit") == product("", **{VARIABLE: KERNELS})


def test_who_has_chosen_others_keeps_them() -> None:
    chosen = subprocess.run(
        [sys.executable, "-c", f"import kit, os; print(os.environ[{VARIABLE!r}])"],
        env=os.environ | {VARIABLE: "Prescott"},
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    assert chosen == "Prescott\n"
