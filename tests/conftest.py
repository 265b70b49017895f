"""Shared by all tests: nothing is written outside the test's own folder, and no test fails because the machine
is busy."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import settings

# The same examples on every run; and how long one takes says more about the machine than about the code.
settings.register_profile("kit", deadline=None, derandomize=True)
settings.load_profile("kit")


@pytest.fixture(autouse=True)
def _own_workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A test that opens the workspace gets one of its own."""
    monkeypatch.setenv("KIT_WORKSPACE", str(tmp_path / "workspace"))
