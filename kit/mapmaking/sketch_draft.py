"""Keeps a map that is being drawn, change by change, so that no end of the program loses it."""

from __future__ import annotations

import json
from contextlib import suppress
from pathlib import Path

from kit.line_log import LineLog
from kit.mapmaking.map_drawing import MAX_SIDE
from kit.mapmaking.map_sketch import MIN_SIDE, MapSketch
from kit.part_file import lock_part, part_path


class SketchDraft:
    """The drawing of one map that is not saved yet: ``.NAME.part`` beside where the map will be, a line a change.

    Only one program may draw a map of that name. Raises BeingWrittenError if another one does, and OSError.
    """

    def __init__(self, folder: Path) -> None:
        """``folder``: of the map."""
        self._folder = folder
        folder.parent.mkdir(parents=True, exist_ok=True)
        self._file = lock_part(part_path(folder), folder)
        self.found = self._read()
        """The drawing as it was left the last time; None where there is none."""
        self._log = LineLog(self._file)
        if self._log.was_cut and self.found is not None:
            self.keep(self.found)  # its line may have been whole but for its end

    def keep(self, sketch: MapSketch) -> str:
        """Writes the drawing as it is now. Returns why that was not possible; empty if it was."""
        try:
            self._log.append(json.dumps({"cell": sketch.cell, "rows": sketch.rows}).encode())
        except OSError as error:
            return f"The drawing is not on the disk: {error.strerror}."
        return ""

    def close(self, *, keeps: bool) -> None:
        """Ends the drawing. ``keeps``: it is wanted the next time, because it has been neither saved nor given up."""
        with suppress(OSError):
            if not keeps or not self._file.seek(0, 2):
                part_path(self._folder).unlink()
        with suppress(OSError):
            self._file.close()

    def _read(self) -> MapSketch | None:
        found = None
        self._file.seek(0)
        with suppress(ValueError, KeyError, TypeError):  # the last line was being written
            for line in self._file:
                entry = json.loads(line)
                rows = tuple(map(str, entry["rows"]))
                sides = {len(row) for row in rows} | {len(rows)}
                if min(sides) < MIN_SIDE or max(sides) > MAX_SIDE or len({len(row) for row in rows}) != 1:
                    break
                found = MapSketch(rows, float(entry["cell"]))
        return found
