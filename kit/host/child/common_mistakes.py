"""What Python's own words for a beginner's commonest mistakes mean."""

from __future__ import annotations

import re
from typing import Final

FUNCTION: Final = "(builtin_function_or_method|function|method)"
MEANINGS: Final = (
    (
        r"'NoneType' object|'NoneType' and|and 'NoneType'|^(?!.* must return ).*\bnot NoneType\b|not 'NoneType'",
        "Something here is None: given so, not set yet, or from a call that returns nothing, as append does.",
    ),
    (
        r"can't multiply sequence by|unsupported operand type\(s\) for .+: ('list' and|'\w+' and 'list')",
        "A list is not a number: take its entries, one by one.",
    ),
    (
        r"list indices must be integers or slices, not tuple",
        "A list of lists is indexed twice: table[row][column].",
    ),
    (
        r"list indices must be integers or slices, not",
        "An index is a place in the list: 0, 1, 2, ... The place of a value is index(value).",
    ),
    (
        rf"'{FUNCTION}' object is not (subscriptable|iterable)|'{FUNCTION}' and|and '{FUNCTION}'",
        "It is a function that was not called: call it with round brackets.",
    ),
    (
        r"'(float|int)' object (is not (subscriptable|iterable)|does not support item)|'(float|int)' has no len",
        "It is a single number, not a list.",
    ),
    (
        r"'float' object cannot be interpreted as an integer",
        "A whole number is needed: // divides without a remainder, int(x) cuts off the decimals.",
    ),
    (
        r"missing \d+ required positional argument",
        "Is it to be called later? Then give its name alone: brackets behind it call it at once.",
    ),
    (
        r"got an unexpected keyword argument",
        "It has no parameter of this name; parameters keep the names that they have in the starter.",
    ),
    (
        r"unhashable type: '(list|dict|set)'",
        "A set, or the keys of a dictionary, cannot hold a list. They can hold a tuple: tuple(x).",
    ),
    (r"list index out of range", "A list with n entries has the indices 0 to n - 1."),
    (r"string index out of range", "A text with n characters has the indices 0 to n - 1."),
    (
        r"^(max|min)\(\) (arg|iterable argument) is (an )?empty",
        "The list is empty here, and so has no largest or smallest entry.",
    ),
    (
        r"^(not enough|too many) values to unpack",
        "On the left of = stands another number of names than there are values on the right.",
    ),
    (
        r"^(math domain error|expected a (nonnegative|positive) input)",
        "Such a root takes no negative number, and a logarithm no 0 either.",
    ),
    (
        r"^cannot access local variable",
        "It gets its value further down, or in a branch that was not taken.",
    ),
)
"""Patterns of an exception's text, and what to say; the first that is found counts."""
TOO_MANY: Final = re.compile(
    r"^(\w+\.)+\w+\(\) takes (\d+) positional arguments? but (\d+) (was|were) given$"
)


def meaning(problem: BaseException) -> str:
    """Returns the end of the message about an exception; empty if its own text says enough."""
    if not isinstance(problem, (TypeError, IndexError, AttributeError, UnboundLocalError, ValueError)):
        return ""
    text = str(problem)
    found = TOO_MANY.match(text)
    if found is not None and int(found[3]) == int(found[2]) + 1:
        return ". Is self the first parameter of the method? Python passes it by itself."
    return next((f". {words}" for pattern, words in MEANINGS if re.search(pattern, text)), "")
