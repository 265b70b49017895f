"""Writes a recording while its run goes on, and restores what a run has left that was killed.

``.NAME.part`` holds lines of JSON: the recording's header, then every half second what has been recorded since. When the
run ends, however it ends but by SIGKILL, NAME is written and the part goes.
"""

from __future__ import annotations

import base64
import json
import os
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO, Final, Self

import numpy as np

from kit.part_file import BeingWrittenError, lock_part, part_path, parts_in, path_of_part, unused_path
from kit.run.recording import (
    MAX_RECORDED_BYTES,
    NOTHING,
    Recorder,
    Recording,
    RecordingError,
    recording_from_header,
    recording_header,
    save_recording,
)
from kit.workspace import check_writable, is_special

INTERVAL_S: Final = 0.5
"""After this long what was recorded is written [s]."""
MAX_PART_BYTES: Final = 4 * MAX_RECORDED_BYTES
"""Bytes of what a killed run has left."""


class RecordingFile:
    """The file of one recording, from before the run until it is complete. Only one program may have it open.

    What a killed run has left of this file, or of others in its folder, is restored first; ``notices`` says so. Raises
    OSError if the file cannot be written, and BeingWrittenError, one of those, if another run records into it.
    """

    def __init__(self, file: Path) -> None:
        self.file = file
        check_writable(file)
        self.notices = tuple(restore_recordings(file.parent, wanted=file))
        """A sentence for each recording that was restored."""
        self._part: BinaryIO | None = None
        if not is_special(file):
            self._part = lock_part(part_path(file), file)
        self._written = NOTHING
        self._written_s = 0.0
        self._failure: OSError | None = None
        self.remark = ""
        """A sentence about what of the run is not recorded; empty if there is nothing to say."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def begin(self, first: Recording) -> None:
        """Starts anew: what was recorded before is given up, unless it is complete."""
        self._written, self._failure, self.remark = NOTHING, None, ""
        if self._part is None and not is_special(self.file):
            try:
                self._part = lock_part(part_path(self.file), self.file)
            except OSError as error:  # the run goes on, and is written at its end
                self._failure = error
        if self._part is not None:
            self._part.truncate(0)
            self._write(recording_header(first))

    def offer(self, recorder: Recorder) -> None:
        """Writes what was recorded since the last time, at most every half second and once it is full."""
        if self.remark:
            return
        now_s = time.monotonic()
        if recorder.is_full:
            self.remark = f"{self.file} holds the first {recorder.ticks:,} ticks of the run, as many as a recording may hold."
        elif now_s - self._written_s < INTERVAL_S:
            return
        if self._part is None or self._failure is not None:
            return
        self._written_s = now_s
        news = recorder.recording(self._written)
        arrays = {name: base64.b64encode(getattr(news, name)).decode() for name in ("poses", "counts")}
        self._write({key: recording_header(news)[key] for key in ("models", "inputs")} | arrays)
        self._written = self._written.plus(news)

    def complete(self, recording: Recording) -> None:
        """Writes the file whole. Raises OSError, which says where what there is of it lies if it could not be written."""
        try:
            save_recording(recording, self.file)
        except OSError as error:
            if self._part is None or not self._written.ticks:
                raise
            kept_s = self._written.ticks * recording.step_size
            raise OSError(
                f"{self.file}: {error.strerror}. The first {kept_s:.1f} s of it are kept; "
                f"`kit replay {self.file}` restores them once it can be written."
            ) from None
        if self._part is not None:
            with suppress(OSError):
                part_path(self.file).unlink()
        self.close()

    def close(self) -> None:
        """Lets others write. What was not completed is restored at the next start; nothing is left where nothing was
        recorded."""
        if self._part is not None:
            with suppress(OSError):
                if not self._written.ticks:
                    part_path(self.file).unlink()
            with suppress(OSError):  # of what could not be written, and was said
                self._part.close()
            self._part = None

    def _write(self, line: dict[str, Any]) -> None:
        assert self._part is not None
        try:
            self._part.write(json.dumps(line).encode() + b"\n")
            self._part.flush()
        except OSError as error:  # the run goes on, and its end says so
            self._failure = error


def restore_recordings(folder: Path, wanted: Path | None = None) -> Iterator[str]:
    """Completes all recordings in a folder that killed runs have left, and yields a sentence for each.

    ``wanted``: a name that is to stay free. What another program writes now is left alone; so is what cannot be written, of which the sentence says why.
    """
    for part in parts_in(folder):
        if part.is_file() and (notice := _restore_part(part, wanted)):
            yield notice


def _restore_part(part: Path, wanted: Path | None) -> str:
    """The sentence about one part; empty for one that is none, has nothing in it, or is being written."""
    file = path_of_part(part)
    try:
        with lock_part(part, file) as lines:
            if lines.seek(0, os.SEEK_END) > MAX_PART_BYTES:  # somebody else's
                return ""
            lines.seek(0)
            recording = _read_recording(lines)
            if recording is None and part.stat().st_size:  # somebody else's
                return ""
            if recording is None or not recording.ticks:
                part.unlink()
                return ""
            restored = unused_path(file, wanted)
            save_recording(recording, restored)
            part.unlink()
    except BeingWrittenError:
        return ""
    except OSError as error:
        return f"{part}: what a run that was killed has left cannot be restored ({error.strerror})."
    kept_s = recording.ticks * recording.step_size
    return f"{restored}: restored from a run that was killed; its first {kept_s:.1f} s are there."


def _read_recording(lines: BinaryIO) -> Recording | None:
    """What was recorded, to the last line that is whole; None where it is no recording."""
    header: dict[str, Any] | None = None
    poses, counts = [np.empty((0, 3))], [np.empty(0, np.int64)]
    with suppress(ValueError, KeyError, TypeError, RecursionError):  # the last line was being written
        for line in lines:
            entry = json.loads(line)
            if header is None:
                header = entry
                continue
            new_poses = np.frombuffer(base64.b64decode(entry["poses"])).reshape(-1, 3)
            new_counts = np.frombuffer(base64.b64decode(entry["counts"]), np.int64)
            header["models"] += entry["models"]
            header["inputs"] += entry["inputs"]
            poses.append(new_poses)
            counts.append(new_counts)
    if header is None:
        return None
    try:
        return recording_from_header(header, np.concatenate(poses), np.concatenate(counts))
    except (ValueError, KeyError, TypeError, AttributeError, RecordingError):
        return None
