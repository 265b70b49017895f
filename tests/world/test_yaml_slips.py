"""Common slips in YAML: the right line, and the cure."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.world.documents import WorldDocuments
from kit.world.files import AllowedRoot
from kit.world.problems import ProblemCollector, WorldError
from kit.world.records import SourceLocation


def message_of(folder: Path, text: str) -> str:
    """What is said of a file with this text, without its folder."""
    file = folder / "a.yaml"
    file.write_text(text)
    problems = ProblemCollector()
    WorldDocuments(AllowedRoot.of_folder(folder), {}, problems).section(file, SourceLocation(file))
    with pytest.raises(WorldError) as refused:
        problems.raise_if_any()
    return str(refused.value).replace(f"{folder}/", "")


@pytest.mark.parametrize(
    ("text", "place", "cure"),
    [
        ("# mine\npressed:/keys\ntold: /cmd_vel\n", "a.yaml:2:8", 'a blank is missing after the colon: write "pressed: /keys"'),
        ("told: /x\npressed:/keys\nback: /y\n", "a.yaml:2:8", 'write "pressed: /keys"'),
        ("told: /x\npressed:/keys\n", "a.yaml:2:8", 'write "pressed: /keys"'),
        ("pressed:/keys\n", "a.yaml:1:1", 'write "pressed: /keys"'),
        ("told: /x\nlist:\n  - name:hall\n    map: /y\n", "a.yaml:3:9", 'write "- name: hall"'),
        ("a:\n\tb: 1\n", "a.yaml:2:1", "indented with a tab"),
        ("a: 1\n\tb: 2\n", "a.yaml:2:1", "indented with a tab"),
        ("a: [1, 2\nb: 3\nc: 4\n", "a.yaml:1:4", 'this "[" is not closed: a "]" is missing'),
        ("a: [1, 2\n", "a.yaml:1:4", 'a "]" is missing'),
        ("a: {x: 1\nb: 2\n", "a.yaml:1:4", 'a "}" is missing'),
        ("a: 'x\nb: 1\nc: 2\n", "a.yaml:1:4", "quotation mark that opens here is not closed"),
        ("a: b: c\n", "a.yaml:1:5", "second colon in one line"),
        ("a: 1\n  b: 2\n", "a.yaml:2:1", "indented further than the one above"),
        ("a:\n  b: 1\n c: 2\n", "a.yaml:3:2", "another column"),
        ("a: @x\n", "a.yaml:1:4", '"@" cannot begin a value'),
    ],
)  # fmt: skip
def test_a_slip_is_reported_in_its_own_line_with_its_cure(
    tmp_path: Path, text: str, place: str, cure: str
) -> None:
    message = message_of(tmp_path, text)
    assert message.startswith(f"{place}: "), message
    assert cure in message


def test_an_address_is_no_slip(tmp_path: Path) -> None:
    assert "blank" not in message_of(tmp_path, "http://example.org\n")


def test_what_is_no_common_slip_keeps_the_parser_s_words(tmp_path: Path) -> None:
    assert "not valid YAML" in message_of(tmp_path, "- a\nb: 1\n")
