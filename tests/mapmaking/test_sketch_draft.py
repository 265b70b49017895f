"""A map that is being drawn outlives any end of the program."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.mapmaking.map_sketch import MapSketch
from kit.mapmaking.sketch_draft import SketchDraft
from kit.part_file import BeingWrittenError, part_path

SKETCH = MapSketch.room(8, 5, 0.25)


@pytest.mark.parametrize(("lost", "kept"), [(0, "T"), (1, "T"), (5, "S")])
def test_the_last_whole_change_is_found(tmp_path: Path, lost: int, kept: str) -> None:
    draft = SketchDraft(tmp_path / "hall")
    for mark in ("S", "T"):
        assert draft.keep(SKETCH.drawn(mark, (2, 2))) == ""  # type: ignore[arg-type]
    with pytest.raises(BeingWrittenError):
        SketchDraft(tmp_path / "hall")
    draft.close(keeps=True)
    part = part_path(tmp_path / "hall")
    part.write_bytes(part.read_bytes()[: part.stat().st_size - lost])
    again = SketchDraft(tmp_path / "hall")
    assert again.found is not None
    assert (again.found.rows[2][2], again.found.cell) == (kept, 0.25)
    again.close(keeps=True)
    third = SketchDraft(tmp_path / "hall")
    assert third.found == again.found
    assert third.keep(SKETCH.drawn("T", (3, 3))) == ""
    third.close(keeps=True)
    again = SketchDraft(tmp_path / "hall")
    assert again.found is not None
    assert again.found.rows[3][3] == "T", "what was drawn after half a line is found too"
    again.close(keeps=False)
    assert list(tmp_path.iterdir()) == []


def test_nothing_drawn_leaves_nothing(tmp_path: Path) -> None:
    draft = SketchDraft(tmp_path / "hall")
    assert draft.found is None
    draft.close(keeps=True)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "line", ["[]", '{"rows": ["#"], "cell": 1}', '{"rows": ["####", "##"], "cell": 1}', "{}"]
)
def test_what_is_no_drawing_is_none(tmp_path: Path, line: str) -> None:
    part_path(tmp_path / "hall").write_text(line + "\n")
    draft = SketchDraft(tmp_path / "hall")
    assert draft.found is None
    draft.close(keeps=False)
