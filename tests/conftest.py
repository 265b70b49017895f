"""Shared by all tests: nothing is written outside the test's own folder."""

from __future__ import annotations

from pathlib import Path

import pytest


@pytest.fixture(autouse=True)
def _own_workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A test that opens the workspace gets one of its own."""
    monkeypatch.setenv("KIT_WORKSPACE", str(tmp_path / "workspace"))
