"""The tests in a file for launch_testing: which belong to one launch, what they are given, and how each of them ended."""

from __future__ import annotations

import functools
import inspect
import unittest
from collections.abc import Callable, Iterator, Mapping
from types import ModuleType
from typing import Any, Final

from kit.ros.launch.context import LaunchError
from kit.ros.launch.description_sources import TEST_GENERATOR_FUNCTION
from kit.ros.launch.entity import LaunchDescription, LaunchDescriptionEntity
from kit.ros.launch.testing.marks import ReadyToTest

READY_TIMEOUT_S: Final = 15.0
"""How long the tests wait for ReadyToTest, unless the launch description is marked with another time [s]."""


class LaunchTestRun:
    """One launch of a test file, with the values for which it is launched."""

    def __init__(self, module: ModuleType, generate: Callable[..., Any], values: Mapping[str, Any]) -> None:
        self.values = values
        """The values of its arguments, where the file is launched once for each of several."""
        self._generate = generate
        function = generate.func if isinstance(generate, functools.partial) else generate
        self.keeps_alive = hasattr(function, "__launch_test_keep_alive__")
        self.ready_timeout_s: float = getattr(function, "__ready_to_test_action_timeout__", READY_TIMEOUT_S)
        self.active_tests = _load_tests(module, is_after=False)
        self.tests_after = _load_tests(module, is_after=True)
        """Those that run when the processes have ended."""

    @property
    def suffix(self) -> str:
        """The values as the end of a name, such as ``[fast, 3]``; empty without any."""
        return f"[{', '.join(map(str, self.values.values()))}]" if self.values else ""

    def describe(self) -> tuple[LaunchDescription, dict[str, Any]]:
        """The launch description, and what the file gives its tests besides. Raises LaunchError, SkipTest, and what the file raises."""
        described = self._generate()
        description, context = described if isinstance(described, tuple) else (described, {})
        if not isinstance(description, LaunchDescription):
            raise LaunchError(
                f"{TEST_GENERATOR_FUNCTION}() must return a LaunchDescription, alone or with a dictionary, "
                f"not {type(description).__name__}"
            )
        if not any(isinstance(each, ReadyToTest) for each in _all_entities(description)):
            raise LaunchError(
                f"{TEST_GENERATOR_FUNCTION}() must return a launch description with a ReadyToTest action, "
                "which says when the tests may begin"
            )
        return description, {**context, **self.values}

    def bind(
        self, suite: unittest.TestSuite, given: Mapping[str, Any], attributes: Mapping[str, Any]
    ) -> None:
        """Gives the tests of a suite what they, their ``setUp`` or their classes name as arguments; ``attributes`` to all."""
        for test in list(_all_tests(suite)):
            for name in (test._testMethodName, "setUp", "tearDown"):
                setattr(test, name, _bound(getattr(test, name), given))
            for name, value in attributes.items():
                setattr(test, name, value)
            if self.values:
                method = getattr(test, test._testMethodName)
                test._testMethodName += self.suffix
                setattr(test, test._testMethodName, method)
        for case in {type(test): None for test in _all_tests(suite)}:
            for name in ("setUpClass", "tearDownClass"):
                setattr(case, name, _bound(getattr(case, name), given))


def read_test_runs(module: ModuleType) -> list[LaunchTestRun]:
    """The launches of a test file: one, or one for each value that it is to be launched with. Raises LaunchError."""
    generate = getattr(module, TEST_GENERATOR_FUNCTION, None)
    if not callable(generate):
        raise LaunchError(f"there is no {TEST_GENERATOR_FUNCTION}() in it: it is no test for launch_testing")
    sets = generate() if hasattr(generate, "__parametrized__") else [(generate, {})]
    return [LaunchTestRun(module, function, values) for function, values in sets]


class LaunchTestResult(unittest.TextTestResult):
    """Also keeps how each test ended, and how long it took by ``clock`` [s]."""

    def __init__(self, *args: Any, clock: Callable[[], float], **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._clock = clock
        self._began: dict[unittest.TestCase, float] = {}
        self._taken: dict[unittest.TestCase, float] = {}

    def startTest(self, test: unittest.TestCase) -> None:  # noqa: N802 - unittest's name, as below
        self._began[test] = self._clock()
        super().startTest(test)

    def stopTest(self, test: unittest.TestCase) -> None:  # noqa: N802
        super().stopTest(test)
        self._taken[test] = self._clock() - self._began[test]

    def cases(self) -> Iterator[tuple[str, str, float, str, str]]:
        """Class, name, seconds, outcome (passed, failure, error, skipped) and message of each test."""
        found: dict[Any, tuple[str, str]] = dict.fromkeys(self._began, ("passed", ""))
        found |= dict.fromkeys(self.unexpectedSuccesses, ("failure", "unexpected success"))
        for outcome, entries in (
            ("skipped", self.skipped),
            ("failure", self.failures),
            ("error", self.errors),
        ):
            # A subtest counts as its test; a class that could not be set up has no test of its own.
            found |= {getattr(test, "test_case", test): (outcome, text) for test, text in entries}
        for test, (outcome, text) in found.items():
            name = getattr(test, "_testMethodName", "") or str(test)
            yield type(test).__name__, name, self._taken.get(test, 0.0), outcome, text


def run_tests(suite: unittest.TestSuite, clock: Callable[[], float]) -> LaunchTestResult:
    """Runs tests as ``unittest`` does, and prints what it prints."""
    runner = unittest.TextTestRunner(
        verbosity=2, resultclass=functools.partial(LaunchTestResult, clock=clock)
    )
    result = runner.run(suite)
    assert isinstance(result, LaunchTestResult)
    return result


def _load_tests(module: ModuleType, *, is_after: bool) -> unittest.TestSuite:
    loader = unittest.TestLoader()
    cases = [
        each
        for each in vars(module).values()
        if isinstance(each, type)
        and issubclass(each, unittest.TestCase)
        and each not in (unittest.TestCase, unittest.FunctionTestCase)
        and bool(getattr(each, "__post_shutdown_test__", False)) == is_after
    ]
    # Classes of their own: what one is given must not reach another launch.
    own = [type(each.__name__, (each,), {"__module__": each.__module__}) for each in cases]
    return unittest.TestSuite(loader.loadTestsFromTestCase(each) for each in own)


def _all_tests(suite: unittest.TestSuite) -> Iterator[Any]:
    for each in suite:
        if isinstance(each, unittest.TestSuite):
            yield from _all_tests(each)
        else:
            yield each


def _all_entities(entity: LaunchDescriptionEntity) -> Iterator[LaunchDescriptionEntity]:
    yield entity
    for each in entity.sub_entities():
        yield from _all_entities(each)


def _bound(function: Callable[..., Any], given: Mapping[str, Any]) -> Callable[..., Any]:
    """The function with those of the values that it names as arguments."""
    names = inspect.signature(function).parameters
    return functools.partial(function, **{name: value for name, value in given.items() if name in names})
