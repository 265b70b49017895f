"""The glossary: every term that a lesson introduces in bold is in it, with the lesson that comes first."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.document.layout import lines_of
from kit.school.lessons.glossary import UnknownTerm, find_terms, glossary_blocks, read_glossary
from kit.school.lessons.reading import lesson_names
from kit.world.problems import WorldError
from tests.kit_content import kit_lesson

TERMS = read_glossary()
BOLD = re.compile(r"\*\*([^*]+)\*\*")
EMPHASIS = frozenset(
    """
    speed|nearest|drive|is|without brackets|at the top|path|it is written in|it|metres per pixel
    |8 m wide and 6 m high|middle|4 m wide and 3 m high|centimetres|y points to the left.|in that body's frame|3 cm
    |2 cm|sixteen layers|they share at least one layer|all|the laser's|every|two|third|everyone|not|proof|prove
    |no two fit one layer|three|fewest|everything|ten|four|name|stopped|speed divided by rate|0.3 m|and|once
    |in proportion|on its right|whole episode|difference|beginner|not below|worst|keep the best|wall
    |Side by side|lower left corner|measure something|told what to do
    |A wall runs along the edge between a dark and a bright pixel.|is there a future from here?|around it
    """.replace("\n    ", "").split("|")
)
"""Words that are bold because a reader must not miss them, and no terms."""


def bold_in(name: str) -> list[str]:
    """What stands in bold in a lesson's texts, in their order."""
    steps = kit_lesson(name).steps
    return [" ".join(found.split()) for step in steps for found in BOLD.findall(step.text)]


def test_every_term_in_bold_is_in_it_with_the_lesson_that_comes_first() -> None:
    first: dict[str, str] = {}
    for lesson in lesson_names():
        for words in bold_in(lesson):
            known = [each for each in TERMS if each.matches(words)]
            assert known or words in EMPHASIS, f"{lesson}: **{words}** is not in the glossary"
            for each in known:
                first.setdefault(each.term, lesson)
    assert first == {each.term: each.lesson for each in TERMS}


def test_no_feedback_is_marked_up() -> None:
    """It is shown as it is written."""
    steps = [step for name in lesson_names() for step in kit_lesson(name).steps]
    assert [each.feedback for step in steps for each in step.options if "**" in each.feedback] == []


def test_nothing_is_kept_as_emphasis_that_no_lesson_has() -> None:
    assert {words.strip() for words in EMPHASIS} <= {
        words.strip() for lesson in lesson_names() for words in bold_in(lesson)
    }


def test_meanings_are_a_sentence_or_two_that_fit_the_screen() -> None:
    for each in TERMS:
        assert each.meaning.endswith("."), each.term
        assert len(re.findall(r"[.?!](?= |$)", each.meaning)) <= 3, each.term
        assert all(len(line) <= 78 for line in lines_of(each.blocks()))
    assert len(lines_of(glossary_blocks(TERMS))) > 2 * len(TERMS)


@pytest.mark.parametrize("word", ["node", "Nodes", "QoS", "quality of service", "footprints"])
def test_a_term_is_found_by_any_of_its_spellings(word: str) -> None:
    (found,) = find_terms(TERMS, word)
    shown = CliRunner().invoke(main, ["glossary", *word.split()])
    assert shown.exit_code == 0
    assert shown.output.splitlines() == lines_of(found.blocks())


def test_an_unknown_term_has_a_nearest_one() -> None:
    with pytest.raises(UnknownTerm, match="deadlock"):
        find_terms(TERMS, "deadlok")
    assert CliRunner().invoke(main, ["glossary", "deadlok"]).exit_code != 0


def test_a_term_that_stands_twice_is_told_with_its_line(tmp_path: Path) -> None:
    row = "  - {term: node, lesson: 01-drive, means: A program.}\n"
    (tmp_path / "glossary.yaml").write_text("terms:\n" + row + row.replace("node", "Node"))
    with pytest.raises(WorldError, match=r"glossary\.yaml:3"):
        read_glossary(tmp_path)


def test_a_word_that_is_no_term_is_looked_for_where_words_begin() -> None:
    assert [each.term for each in find_terms(TERMS, "lidar")] == ["Laser"]
    assert "latency" in [each.term for each in find_terms(TERMS, "scan")], "named in its meaning"
    with pytest.raises(UnknownTerm, match="kit glossary"):  # in the middle of "simulator"
        find_terms(TERMS, "imu")
