"""A student's file in the child: its text, and the module made of it."""

from __future__ import annotations

import os
import sys
from types import ModuleType, TracebackType


class Program:
    """One file, as its bytes were when it was started."""

    def __init__(self, file: str, source: bytes) -> None:
        self.file = file
        self.folder = os.path.dirname(file)
        self._source = source

    def load(self, name: str) -> ModuleType:
        """Runs the file as the module ``name``. Raises what the student's code raises."""
        module = ModuleType(name)
        module.__file__ = self.file
        sys.modules[name] = module
        exec(compile(self._source, self.file, "exec", dont_inherit=True), module.__dict__)
        return module

    def frames(self, trace: TracebackType | None) -> list[tuple[str, int, str]]:
        """The student's own part of a traceback: file relative to the folder, line, function; outermost first."""
        found = []
        while trace is not None:
            code = trace.tb_frame.f_code
            relative = self.relative(code.co_filename)
            if relative is not None:
                found.append((relative, trace.tb_lineno, code.co_name))
            trace = trace.tb_next
        return found

    def relative(self, file: str | None) -> str | None:
        """A file's path relative to the student's folder; None if it lies elsewhere or in an environment there."""
        if file is None or not file.startswith(self.folder + os.sep) or "site-packages" in file:
            return None
        return file[len(self.folder) + 1 :]

    def text(self, file: str, line: int) -> str:
        """A line of one of the student's files, without its indentation; empty if it cannot be read."""
        source = self._source
        if self.relative(self.file) != file:
            try:
                with open(f"{self.folder}/{file}", "rb") as opened:
                    source = opened.read()
            except OSError:
                return ""
        lines = source.splitlines()
        return lines[line - 1].decode("utf-8", "replace").strip() if line <= len(lines) else ""
