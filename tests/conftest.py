"""Shared by all tests: nothing is written outside the test's own folder, and no test fails because the machine
is busy."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest
from hypothesis import settings

# The same examples on every run; and how long one takes says more about the machine than about the code.
settings.register_profile("kit", deadline=None, derandomize=True)
settings.load_profile("kit")

# A shell's background job is started deaf to Ctrl-C, what `nohup` starts deaf to the end of its terminal, and so would
# be every program that a test starts.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGQUIT, signal.SIG_DFL)
signal.signal(signal.SIGHUP, signal.SIG_DFL)


@pytest.fixture(autouse=True)
def _own_workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A test that opens the workspace gets one of its own."""
    monkeypatch.setenv("KIT_WORKSPACE", str(tmp_path / "workspace"))
