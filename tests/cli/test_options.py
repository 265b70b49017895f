"""What several verbs share."""

from __future__ import annotations

import pytest

from kit.school.progress import FILE, EventKind, ProgressJournal
from kit.workspace import open_workspace
from tests.cli.verbs import kit


@pytest.mark.parametrize(
    "arguments",
    [("form", "before", "--show"), ("progress",), ("quiz", "--scores"), ("game", "--plain"), ("lesson",)],
    ids=" ".join,
)
def test_a_damaged_journal_is_told_by_every_verb_that_opens_it(arguments: tuple[str, ...]) -> None:
    folder = open_workspace().folder
    with ProgressJournal(folder) as journal:
        journal.add(EventKind.STEP, "lesson/1")
    (folder / FILE).write_bytes(b"no database at all" * 100)
    result = kit(*arguments)
    assert "was damaged. It was saved as" in result.stderr
    assert "was damaged" not in result.stdout
