"""One test for many small cases: as tests of their own, collecting and reporting them would take longer than they do."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Sequence
from functools import wraps
from typing import Any

import pytest
from _pytest.mark import ParameterSet

TestFunction = Callable[..., None]


def every_case(
    argnames: str | Sequence[str],
    argvalues: Iterable[object],
    ids: Iterable[str] | Callable[[Any], object] | None = None,
) -> Callable[[TestFunction], TestFunction]:
    """Calls the test with each case, and reports all that fail. The arguments are those of ``parametrize``.

    For cases that need no fixture of their own, cannot be skipped and take a millisecond or so.
    """
    names = [name.strip() for name in argnames.split(",")] if isinstance(argnames, str) else list(argnames)
    cases = [_values_and_id(case, len(names)) for case in argvalues]
    if callable(ids):
        cases = [(values, "-".join(str(ids(value)) for value in values)) for values, _ in cases]
    elif ids is not None:
        cases = [(values, name) for (values, _), name in zip(cases, ids, strict=True)]
    assert cases, "a test of no case cannot fail"

    def over_all_cases(function: TestFunction) -> TestFunction:
        @wraps(function)
        def test(**fixtures: object) -> None:
            failures: list[BaseException] = []
            for values, name in cases:
                try:
                    function(**dict(zip(names, values, strict=True)), **fixtures)
                except (Exception, pytest.fail.Exception) as failure:  # noqa: BLE001 - reported below
                    failure.add_note(f"Case: {name}")
                    failures.append(failure)
            if failures:
                raise BaseExceptionGroup(f"{len(failures)} of {len(cases)} cases failed", failures)

        signature = inspect.signature(function)
        left = [each for name, each in signature.parameters.items() if name not in names]
        test.__signature__ = signature.replace(parameters=left)  # type: ignore[attr-defined]  # what pytest reads
        return test

    return over_all_cases


def _values_and_id(case: object, count: int) -> tuple[Sequence[object], str]:
    if isinstance(case, ParameterSet):
        assert not case.marks, "a marked case is a test of its own"
        return case.values, str(case.id or case.values)
    values = [case] if count == 1 else list(case)  # type: ignore[call-overload]  # a tuple of that many
    return values, ", ".join(map(repr, values))
