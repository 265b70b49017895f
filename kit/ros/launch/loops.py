"""Loops of a launch file: ``ForEach`` and ``ForLoop``, and the values of their turns."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from copy import deepcopy
from typing import Any, Final

from kit.ros.launch.bounds import MAX_ACTIONS
from kit.ros.launch.context import LaunchContext, LaunchError, SubstitutionFailure
from kit.ros.launch.entity import (
    Action,
    Condition,
    LaunchDescriptionEntity,
    to_entities,
)
from kit.ros.launch.substitutions import (
    SomeText,
    Substitution,
    as_text,
    describe_substitutions,
    normalize_to_substitutions,
    perform_substitutions,
)

_SEPARATOR: Final = ";"


class ForEach(Action):
    """Carries out what ``function`` returns for each set of values: ``{name: a, id: 1};{name: b, id: 2}``.

    The function is called with the values by name, as ``function(name="a", id=1)``.
    """

    def __init__(
        self,
        input_values: SomeText,
        *,
        function: Callable[..., Any],
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.input_values = normalize_to_substitutions(input_values)
        self.function = function

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        text = perform_substitutions(context, self.input_values)
        sets = [_read_values(part.strip()) for part in text.split(_SEPARATOR) if part.strip()]
        if not sets:
            context.request("log", "WARN", "a ForEach has no values: it does nothing")
        return [entity for values in sets for entity in to_entities(self.function(**values))]


class ForLoop(Action):
    """Carries out what ``function`` returns for each ``i`` from 0 to ``length`` - 1."""

    def __init__(
        self,
        length: Any,
        *,
        function: Callable[..., Any],
        name: str | None = None,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.length = normalize_to_substitutions(as_text(length))
        self.function, self.name = function, name

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        text = perform_substitutions(context, self.length)
        try:
            rounds = range(int(text))
        except ValueError:
            raise LaunchError(f"the length of a loop is '{text}', which is not a whole number") from None
        if rounds.stop > MAX_ACTIONS:
            raise LaunchError(
                f"a loop of {rounds.stop:,} rounds: at most {MAX_ACTIONS:,} actions are carried out at once"
            )
        return [entity for i in rounds for entity in to_entities(self.function(i=i))]


class ForEachVar(Substitution):
    """A value of the present round, by its name."""

    def __init__(self, name: SomeText, *, default_value: SomeText | None = None) -> None:
        self.name = normalize_to_substitutions(name)
        self.default_value = None if default_value is None else normalize_to_substitutions(default_value)

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self.name)
        if name in context.loop_values:
            return context.loop_values[name]
        if self.default_value is not None:
            return perform_substitutions(context, self.default_value)
        there = ", ".join(context.loop_values) or "none: no loop is around it"
        raise SubstitutionFailure(f"the loop has no value '{name}'; available: {there}")

    def describe(self) -> str:
        return f"{type(self).__name__}({describe_substitutions(self.name)})"


class ForLoopIndex(ForEachVar):
    """The number of the present round of the loop of this name, from 0 on."""

    def __init__(self, name: SomeText) -> None:
        super().__init__(name)


class _SetLoopValues(LaunchDescriptionEntity):
    """Replaces the values of the present round."""

    def __init__(self, values: dict[str, str] | None) -> None:
        """None: goes back to those before."""
        self._values = values

    def visit(self, context: LaunchContext) -> None:
        if self._values is None:
            context.pop_loop_values()
        else:
            context.push_loop_values(self._values)


def with_loop_values(
    values: dict[str, Any], entities: Iterable[LaunchDescriptionEntity]
) -> list[LaunchDescriptionEntity]:
    """Copies of entities, carried out with these values of a round.

    >>> [type(each).__name__ for each in with_loop_values({"i": 0}, [])]
    ['_SetLoopValues', '_SetLoopValues']
    """
    texts = {name: str(value) for name, value in values.items()}
    return [_SetLoopValues(texts), *deepcopy(list(entities)), _SetLoopValues(None)]


def _read_values(text: str) -> dict[str, Any]:
    import yaml  # only now: most launch files have no loop

    from kit.yaml_numbers import AmbiguousNumber, UnambiguousLoader

    try:
        found = yaml.load(text, Loader=UnambiguousLoader)
    except AmbiguousNumber as problem:
        raise LaunchError(f"the values of a ForEach: {problem}") from None
    except yaml.YAMLError:
        found = None
    if not isinstance(found, dict) or not all(isinstance(name, str) for name in found):
        raise LaunchError(f"the values of a ForEach look like {{name: value}}; '{text[:60]}' does not")
    return found
