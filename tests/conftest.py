"""Shared by all tests: nothing is written outside the test's own folder, and no test fails because the machine
is busy."""

from __future__ import annotations

import gc
import itertools
import os
import signal
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

from tests.warm_start import cold_starts, is_possible, warm_starts

# The same examples on every run; and how long one takes says more about the machine than about the code.
settings.register_profile("kit", deadline=None, derandomize=True)
settings.load_profile("kit")

# The tests start hundreds of programs, each of which would compile the kit anew where bytecode is not to be kept.
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# What the developer's own terminal can show is not what the tests look at.
for name in ("COLORTERM", "COLORFGBG", "KIT_THEME", "KIT_COLOR"):
    os.environ.pop(name, None)

# A shell's background job is started deaf to Ctrl-C, what `nohup` starts deaf to the end of its terminal, and so would
# be every program that a test starts.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGQUIT, signal.SIG_DFL)
signal.signal(signal.SIGHUP, signal.SIG_DFL)


# What collecting makes lives to the end: nothing of it is garbage, and looking at it again and again takes seconds.
gc.disable()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Tests in a real terminal are ``pty``; ``sampled`` and ``long_cases`` say which cases of a test are ``long``."""
    cases: Counter[str] = Counter()
    for item in items:
        in_terminal = {"terminal", "user"}.intersection(getattr(item, "fixturenames", ()))
        if in_terminal or item.path.stem.endswith("_pty") or item.path.parent.name == "ssh":
            item.add_marker(pytest.mark.pty)
        sampled = item.get_closest_marker("sampled")
        if sampled is not None:
            family = item.nodeid.partition("[")[0]
            if cases[family] % sampled.args[0]:
                item.add_marker(pytest.mark.long)
            cases[family] += 1
        long_cases = item.get_closest_marker("long_cases")
        callspec = getattr(item, "callspec", None)
        if long_cases is not None and callspec is not None and callspec.id in long_cases.args:
            item.add_marker(pytest.mark.long)


def pytest_collection_finish() -> None:
    """The garbage collector need not look at the collected tests again and again: they live to the end."""
    gc.freeze()
    gc.set_threshold(10_000, 10, 10)
    gc.enable()


_unused_names = itertools.count()


@pytest.fixture(autouse=True)
def _own_workspace(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A test that opens the workspace gets one of its own: in its temporary folder, if it has one."""
    # Most tests need no folder, and to make and remove one takes longer than they do.
    if "tmp_path" in request.fixturenames:
        folder: Path = request.getfixturevalue("tmp_path")
    else:
        folder = tmp_path_factory.getbasetemp() / f"unused-{next(_unused_names)}"
    monkeypatch.setenv("KIT_WORKSPACE", str(folder / "workspace"))


@pytest.fixture(scope="session", autouse=True)
def _warm_starts() -> Iterator[None]:
    """Students' processes are forked from a warm interpreter, unless ``KIT_TESTS_COLD`` is set."""
    if os.environ.get("KIT_TESTS_COLD") or not is_possible():
        yield
        return
    with warm_starts():
        yield


@pytest.fixture
def cold_start() -> Iterator[None]:
    """For tests that look at how a student's process is started, or at all that it holds from its start."""
    with cold_starts():
        yield
