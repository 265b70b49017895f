"""Shared by all tests: nothing is written outside the test's own folder, and no test fails because the machine
is busy."""

from __future__ import annotations

import gc
import itertools
import os
import signal
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

from kit.host.program_start import start_cold, started_by
from kit.host.warm_start import warm_starts
from tests.file_selection import may_select, shares

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


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--import-all-tests", action="store_true", help="also import files that `-m` can select no test of"
    )


@pytest.hookimpl(optionalhook=True)
def pytest_configure_node(node: Any) -> None:
    """Tells a worker of ``--dist each`` which share of the test files is its own; the one that replaces it has the same."""
    if node.config.option.dist == "each":
        spec = node.gateway.spec
        if spec.share is None:
            spec.share = int(node.workerinput["workerid"].removeprefix("gw"))
        node.workerinput["share"] = spec.share


class _WholeProgress:
    """Counts the tests of all workers of ``--dist each``: pytest's percentages are of the last one's alone."""

    def __init__(self, session: pytest.Session) -> None:
        self._session = session
        self._counts: dict[str, int] = {}

    @pytest.hookimpl(optionalhook=True)
    def pytest_xdist_node_collection_finished(self, node: Any, ids: Sequence[str]) -> None:
        self._counts[node.gateway.id] = len(ids)

    def pytest_runtest_logstart(self) -> None:
        self._session.testscollected = sum(self._counts.values())


def pytest_sessionstart(session: pytest.Session) -> None:
    if getattr(session.config.option, "dist", "no") == "each":  # the plugin may be switched off
        session.config.pluginmanager.register(_WholeProgress(session))


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """A file that can hold no test which ``-m`` selects is not imported, nor one of another worker's share."""
    if collection_path.suffix != ".py" or config.option.import_all_tests:
        return None
    share = _own_share(config)
    if share is not None and collection_path.name.startswith("test_") and collection_path not in share:
        return True
    try:
        text = collection_path.read_text(encoding="utf-8")
        return True if config.option.markexpr and not may_select(config.option.markexpr, text) else None
    except SyntaxError:
        return None  # pytest reports it


@cache
def _own_share(config: pytest.Config) -> set[Path] | None:
    """The test files of this worker; none, if it has all."""
    worker: dict[str, Any] = getattr(config, "workerinput", {})
    if "share" not in worker:
        return None
    asked = [Path(argument.partition("::")[0]).resolve() for argument in config.args]
    files = {file for path in asked for file in ([path] if path.is_file() else path.rglob("test_*.py"))}
    return shares(files, worker["workercount"])[worker["share"]]


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Gives tests the markers that follow from others: `pty`, `long`, `nightly`, and `flaky` for what leans on the clock.

    ``sampled(n)``: every n-th case of the test runs by default, the others are `long`. ``long_cases(id, ...)`` are too.
    ``daily(n)``: of the long cases of the test every n-th is no more than that, the others are `nightly`.
    """
    cases: Counter[tuple[str, str]] = Counter()
    for item in items:
        family = item.nodeid.partition("[")[0]
        in_terminal = {"terminal", "user"}.intersection(getattr(item, "fixturenames", ()))
        if in_terminal or item.path.stem.endswith("_pty") or item.path.parent.name == "ssh":
            item.add_marker(pytest.mark.pty)
        sampled = item.get_closest_marker("sampled")
        if sampled is not None:
            if cases[family, "sampled"] % sampled.args[0]:
                item.add_marker(pytest.mark.long)
            cases[family, "sampled"] += 1
        long_cases = item.get_closest_marker("long_cases")
        callspec = getattr(item, "callspec", None)
        if long_cases is not None and callspec is not None and callspec.id in long_cases.args:
            item.add_marker(pytest.mark.long)
        daily = item.get_closest_marker("daily")
        if daily is not None and item.get_closest_marker("long") is not None:
            if cases[family, "long"] % daily.args[0]:
                item.add_marker(pytest.mark.nightly)
            cases[family, "long"] += 1
        if item.get_closest_marker("nightly") is not None:
            item.add_marker(pytest.mark.long)
        if os.environ.get("CI") and item.get_closest_marker("leans_on_clock") is not None:
            item.add_marker(pytest.mark.flaky(reruns=1))


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
    if os.environ.get("KIT_TESTS_COLD"):
        yield
        return
    with warm_starts():
        yield


@pytest.fixture
def cold_start() -> Iterator[None]:
    """For tests that look at how a student's process is started, or at all that it holds from its start."""
    with started_by(start_cold):
        yield
