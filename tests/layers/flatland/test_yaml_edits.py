"""Edits of a user's own text: only what has to change does, and what is not safe is refused."""

from __future__ import annotations

import pytest

from kit.layers.flatland.yaml_edits import (
    AddListItem,
    RemoveListItem,
    SetNameList,
    UnsafeEdit,
    YamlChange,
    apply_changes,
)
from kit.layers.flatland.yaml_scalars import format_flow_list, format_scalar
from tests.cases import every_case


@every_case(
    ("before", "changes", "after"),
    [
        (
            "a: {layers: [x, w]}  # why\n",
            [SetNameList((1, 4), "layers", ("w", "z"))],
            "a: {layers: [w, z]}  # why\n",
        ),
        (
            "# top\nname: one # c\nb: 1\n",
            [SetNameList((2, 1), "name", ("one", "two"))],
            "# top\nname: [one, two] # c\nb: 1\n",
        ),
        ("name: 'one'\n", [SetNameList((1, 1), "name", ("t o",))], 'name: ["t o"]\n'),
        ("layers: [x,\n  w]\nb: 1\n", [SetNameList((1, 1), "layers", ())], "layers: []\nb: 1\n"),
        (
            "layers:\n  - x  # first\n\n  # between\n  - w\nb: 1\n",
            [SetNameList((1, 1), "layers", ("x", "z"))],
            "layers:\n  - x  # first\n\n  # between\n  - z\nb: 1\n",
        ),
        (
            "layers:\n- x  # gone\n- w\nb: 1\n",
            [SetNameList((1, 1), "layers", ("w",))],
            "layers:\n# gone\n- w\nb: 1\n",
        ),
        (
            "layers:  # c\n  - x\n  - w\nb: 1\n",
            [SetNameList((1, 1), "layers", ())],
            "layers: []  # c\nb: 1\n",
        ),
        ("layers:\n  - x", [SetNameList((1, 1), "layers", ("x", "w"))], "layers:\n  - x\n  - w"),
        ("layers:\n  - x", [SetNameList((1, 1), "layers", ("w",))], "layers:\n\n  - w"),
        (
            "f:\n  - t: 1\n    d: 2  # kg\n  # end\n",
            [SetNameList((2, 5), "layers", ("x",))],
            "f:\n  - t: 1\n    d: 2  # kg\n    layers: [x]\n  # end\n",
        ),
        (
            "f: [{t: 1, d: 2 }, {t: 3}]\n",
            [SetNameList((1, 5), "layers", ("x",))],
            "f: [{t: 1, d: 2, layers: [x] }, {t: 3}]\n",
        ),
        ("f: [{t: 1,}]\n", [SetNameList((1, 5), "layers", ("x",))], "f: [{t: 1, layers: [x],}]\n"),
        (
            "f:\n  - t: 1\n    p:\n      - [1, 2]\n      - [3, 4]\ng: 1\n",
            [SetNameList((2, 5), "layers", ("x",))],
            "f:\n  - t: 1\n    layers: [x]\n    p:\n      - [1, 2]\n      - [3, 4]\ng: 1\n",
        ),
        (
            "layers:\n  - name: a  # A\n    map: m\n\n  # about b\n  - name: b\n\n  - name: c\nm: 1\n",
            [RemoveListItem((2, 5)), RemoveListItem((8, 5))],
            "layers:\n\n  # about b\n  - name: b\n\nm: 1\n",
        ),
        (
            "layers: [{name: a}, {name: b}, {name: c}]\n",
            [RemoveListItem((1, 10))],
            "layers: [{name: b}, {name: c}]\n",
        ),
        ("layers: [{name: a}, {name: b}]\n", [RemoveListItem((1, 21))], "layers: [{name: a}]\n"),
        (
            "layers:\n    - name: a\n      map: m # c\n\n# end\nm: 1\n",
            [AddListItem("layers", ("x", "w"))],
            "layers:\n    - name: a\n      map: m # c\n    - name: [x, w]\n\n# end\nm: 1\n",
        ),
        ("layers: [{name: a}]\n", [AddListItem("layers", ("x",))], "layers: [{name: a}, {name: [x]}]\n"),
        ("layers: []\n", [AddListItem("layers", ("x",))], "layers: [{name: [x]}]\n"),
        (
            "layers:\r\n  - name: a\r\n  - name: b # c\r\n",
            [SetNameList((2, 5), "name", ("a", "z")), AddListItem("layers", ("x",))],
            "layers:\r\n  - name: [a, z]\r\n  - name: b # c\r\n  - name: [x]\r\n",
        ),
        (
            "layers:\n- {name: a}\n- {name: b}\n",
            [RemoveListItem((2, 3)), AddListItem("layers", ("x",))],
            "layers:\n- {name: b}\n- name: [x]\n",
        ),
    ],
)
def test_an_edit_touches_nothing_else(before: str, changes: list[YamlChange], after: str) -> None:
    assert apply_changes(before, changes) == after


@every_case(
    ("text", "change", "reason"),
    [
        ("a: &x [p]\nb: *x\n", SetNameList((1, 1), "a", ("q",)), "anchor"),
        ("a: &x [p]\nb: 1\n", SetNameList((1, 1), "a", ("q",)), "anchor"),
        ("a: &x {n: [p]}\nb: {n: *x}\n", SetNameList((2, 4), "n", ("q",)), "anchor"),
        ("a: !!seq [p]\n", SetNameList((1, 1), "a", ("q",)), "tag"),
        ("a: [p, # why\n  q]\n", SetNameList((1, 1), "a", ("q",)), "comments"),
        ("a: $include b.yaml\n", SetNameList((1, 1), "a", ("q",)), "computed"),
        ('a: [env("X")]\n', SetNameList((1, 1), "a", ("q",)), "computed"),
        ("a: |\n  p\nb: 1\n", SetNameList((1, 1), "a", ("q",)), "not written as one"),
        ("a: {p: 1}\n", SetNameList((1, 1), "a", ("q",)), "not written as one"),
        ("a:\n  - p\n  - q\n", SetNameList((1, 1), "a", ("q", "p")), "order"),
        ("a:\n  - &n p\nb: *n\n", SetNameList((1, 1), "a", ("q",)), "anchor"),
        ("a: [p]\n", SetNameList((7, 1), "a", ("q",)), "line 7"),
        ("l: [{n: a}]\n", RemoveListItem((1, 5)), "empty"),
        ("l: {n: a}\n", RemoveListItem((1, 4)), "not an item"),
        ("l: [{n: a}, # c\n {n: b}]\n", RemoveListItem((1, 5)), "comments"),
        ("l:\n  - - n: a\n    - n: b\n", RemoveListItem((2, 7)), "more than the item"),
        ("l: 1\n", AddListItem("l", ("x",)), "no list"),
        ("f:\n  p:\n    - 1\n    - 2\n", SetNameList((2, 3), "layers", ("x",)), "no line"),
        ("- a\n", AddListItem("l", ("x",)), "mapping"),
        ("a: [\n", AddListItem("l", ("x",)), "not YAML"),
        ("a: 1\n---\nb: 1\n", AddListItem("l", ("x",)), "not YAML"),
    ],
)
def test_what_cannot_be_edited_without_a_guess_is_refused(text: str, change: YamlChange, reason: str) -> None:
    with pytest.raises(UnsafeEdit, match=reason):
        apply_changes(text, [change])


def test_two_changes_in_one_place_are_refused() -> None:
    with pytest.raises(UnsafeEdit):
        apply_changes("l: [{n: [a]}, {n: b}]\n", [RemoveListItem((1, 5)), SetNameList((1, 5), "n", ("x",))])


@every_case(
    "name", ["a", "a.b", "2d", "yes", "No", "null", "a b", "", "#x", 'q"q', "b\\", "é", "\u2028", "a:"]
)
def test_a_scalar_is_read_as_the_text_it_was_made_of(name: str) -> None:
    import yaml

    assert yaml.safe_load(format_scalar(name)) == name
    assert yaml.safe_load(format_flow_list([name, name])) == [name, name]
