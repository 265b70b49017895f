"""Reads the substitutions in the texts of XML and YAML launch files: ``$(var name)``, ``$(find-pkg-share pkg)/...``."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final, NamedTuple

from kit.plain_text import nearest_name
from kit.ros.launch.bounds import MAX_DEPTH, NESTED_TOO_DEEPLY
from kit.ros.launch.file_substitutions import (
    Command,
    ExecutableInPackage,
    FileContent,
    FindPackagePrefix,
    FindPackageShare,
)
from kit.ros.launch.loops import ForEachVar, ForLoopIndex
from kit.ros.launch.substitutions import (
    AllSubstitution,
    AndSubstitution,
    AnonName,
    AnySubstitution,
    EnvironmentVariable,
    EqualsSubstitution,
    FindExecutable,
    IfElseSubstitution,
    IsEmptySubstitution,
    LaunchConfiguration,
    LaunchLogDir,
    NotEmptySubstitution,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
    ParameterSubstitution,
    PathJoinSubstitution,
    PythonExpression,
    StringJoinSubstitution,
    StringStripSubstitution,
    Substitution,
    TextSubstitution,
    ThisLaunchFile,
    ThisLaunchFileDir,
)

Texts = list[Substitution]


class SubstitutionSyntaxError(Exception):
    """A text that is no right substitution."""


class _Kind(NamedTuple):
    make: Callable[..., Substitution]
    least: int
    most: int


def _environment(name: Texts, default: Texts | None = None) -> Substitution:
    return EnvironmentVariable(name, default_value=default)


def _configuration(name: Texts, default: Texts | None = None) -> Substitution:
    return LaunchConfiguration(name, default=default)


_MANY: Final = 1000
_KINDS: Final[Mapping[str, _Kind]] = MappingProxyType(
    {
        "all": _Kind(AllSubstitution, 1, _MANY),
        "and": _Kind(AndSubstitution, 2, 2),
        "anon": _Kind(AnonName, 1, 1),
        "any": _Kind(AnySubstitution, 1, _MANY),
        "command": _Kind(lambda command, on="fail": Command(command, on_stderr=on), 1, 2),
        "dirname": _Kind(ThisLaunchFileDir, 0, 0),
        "env": _Kind(_environment, 1, 2),
        "equals": _Kind(EqualsSubstitution, 2, 2),
        "eval": _Kind(lambda expression, _="": PythonExpression(expression), 1, 2),
        "exec-in-pkg": _Kind(ExecutableInPackage, 2, 2),
        "file-content": _Kind(FileContent, 1, 1),
        "filename": _Kind(ThisLaunchFile, 0, 0),
        "find-exec": _Kind(lambda name: FindExecutable(name=name), 1, 1),
        "find-pkg-prefix": _Kind(FindPackagePrefix, 1, 1),
        "find-pkg-share": _Kind(FindPackageShare, 1, 1),
        "for-var": _Kind(lambda name, default=None: ForEachVar(name, default_value=default), 1, 2),
        "if": _Kind(IfElseSubstitution, 2, 3),
        "index": _Kind(ForLoopIndex, 1, 1),
        "is-empty": _Kind(IsEmptySubstitution, 1, 1),
        "launch_log_dir": _Kind(LaunchLogDir, 0, 0),
        "log_dir": _Kind(LaunchLogDir, 0, 0),
        "not": _Kind(NotSubstitution, 1, 1),
        "not-empty": _Kind(NotEmptySubstitution, 1, 1),
        "not-equals": _Kind(NotEqualsSubstitution, 2, 2),
        "optenv": _Kind(lambda name, default="": _environment(name, default), 1, 2),
        "or": _Kind(OrSubstitution, 2, 2),
        "param": _Kind(lambda name, default=None: ParameterSubstitution(name, default=default), 1, 2),
        "path-join": _Kind(lambda *parts: PathJoinSubstitution(parts), 1, _MANY),
        "string-join": _Kind(lambda delimiter, *parts: StringJoinSubstitution(parts, delimiter), 1, _MANY),
        "string-strip": _Kind(StringStripSubstitution, 1, 1),
        "var": _Kind(_configuration, 1, 2),
    }
)
"""The substitutions by name: what makes them, and how many arguments they take."""

_NAME: Final = re.compile(r"[\w-]+")


def parse_substitutions(text: str) -> Texts:
    """The parts of a text. Raises SubstitutionSyntaxError."""
    reader = _Reader(text)
    found = reader.read_until(lambda character: False)
    return found or [TextSubstitution(text="")]


def split_words(parts: Texts) -> list[Texts]:
    """Splits at the spaces of the constant parts, but for those in quotes, as a shell would."""
    words: list[Texts] = []
    is_open, quote = False, ""
    for part in parts:
        if not isinstance(part, TextSubstitution):
            words = words if is_open else [*words, []]
            words[-1].append(part)
            is_open = True
            continue
        for character in part.text:
            if character == quote or (not quote and character in "'\""):
                quote = "" if quote else character
            elif character.isspace() and not quote:
                is_open = False
                continue
            else:
                words = words if is_open else [*words, []]
                words[-1].append(TextSubstitution(text=character))
                is_open = True
                continue
            if not is_open:
                words.append([])
                is_open = True
    return words


class _Reader:
    """Reads a text from its beginning to its end."""

    def __init__(self, text: str) -> None:
        self._text, self._at = text, 0
        self._depth = 0
        """Calls that are open."""

    def read_until(self, is_end: Callable[[str], bool]) -> Texts:
        """Reads parts until a character that ends them, which stays."""
        found: Texts = []
        plain = ""
        while self._at < len(self._text) and not is_end(self._text[self._at]):
            if self._text.startswith("\\$", self._at):
                plain += "$"
                self._at += 2
            elif self._text.startswith("$(", self._at):
                if plain:
                    found.append(TextSubstitution(text=plain))
                    plain = ""
                self._at += 2
                found.append(self._read_call())
            else:
                plain += self._text[self._at]
                self._at += 1
        return [*found, TextSubstitution(text=plain)] if plain else found

    def _read_call(self) -> Substitution:
        name = _NAME.match(self._text, self._at)
        if name is None:
            raise SubstitutionSyntaxError("after '$(' comes the name of a substitution")
        self._at = name.end()
        self._depth += 1
        if self._depth > MAX_DEPTH:
            raise SubstitutionSyntaxError(NESTED_TOO_DEEPLY)
        arguments: list[Texts] = []
        while True:
            while self._at < len(self._text) and self._text[self._at].isspace():
                self._at += 1
            if self._at == len(self._text):
                raise SubstitutionSyntaxError(f"'$({name[0]}' is not closed: ')' is missing")
            if self._text[self._at] == ")":
                self._at += 1
                self._depth -= 1
                return _make(name[0], arguments)
            arguments.append(self._read_argument())

    def _read_argument(self) -> Texts:
        quote = self._text[self._at]
        if quote not in "'\"":
            return self.read_until(lambda character: character.isspace() or character == ")")
        self._at += 1
        found = self.read_until(lambda character: character == quote)
        if self._at == len(self._text):
            raise SubstitutionSyntaxError(f"the quote {quote} is not closed")
        self._at += 1
        return found or [TextSubstitution(text="")]


def _make(name: str, arguments: list[Texts]) -> Substitution:
    kind = _KINDS.get(name)
    if kind is None:
        near = nearest_name(name, _KINDS)
        hint = f"did you mean '{near}'?" if near else f"available: {', '.join(_KINDS)}"
        raise SubstitutionSyntaxError(f"there is no substitution '{name}'; {hint}")
    if not kind.least <= len(arguments) <= kind.most:
        wanted = str(kind.least) if kind.least == kind.most else f"{kind.least} or more"
        raise SubstitutionSyntaxError(f"'{name}' takes {wanted} arguments, not {len(arguments)}")
    return kind.make(*arguments)
