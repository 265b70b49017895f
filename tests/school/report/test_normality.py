"""Shapiro and Wilk's test: its authors' example, normal numbers and others."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kit.school.report.normality import shapiro_wilk


def test_shapiro_and_wilk_on_their_own_example() -> None:
    """The weights of eleven men, of the 1965 paper: W = 0.79."""
    weights = np.array([148, 154, 158, 160, 161, 162, 166, 170, 182, 195, 236], dtype=np.float64)
    w, p = shapiro_wilk(weights)
    assert w == pytest.approx(0.7888, abs=5e-4)
    assert p == pytest.approx(0.0067, abs=5e-4)


def test_normal_numbers_pass_and_others_do_not() -> None:
    generator = np.random.default_rng(0)
    passed = np.mean([shapiro_wilk(generator.normal(size=20))[1] > 0.05 for _ in range(300)])
    assert 0.9 < passed < 0.99
    assert shapiro_wilk(generator.exponential(size=100))[1] < 0.001
    assert all(map(math.isnan, shapiro_wilk(np.array([1.0, 2, 3]))))
    assert all(map(math.isnan, shapiro_wilk(np.ones(9))))
