"""A journal may be closed while another thread reads it or writes to it, as when a screen is left that was still loading."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

PROGRAM = """
import sys, threading
from contextlib import suppress
from pathlib import Path
from kit.school.progress import EventKind, ProgressError, ProgressJournal

folder = Path(sys.argv[1])
with ProgressJournal(folder) as journal:
    for number in range(300):
        journal.add(EventKind.ANSWER, f"item-{number}", {"text": "x" * 500})
for _ in range(150):
    journal, begun = ProgressJournal(folder), threading.Event()

    def read():
        with suppress(ProgressError):
            while True:
                assert len(journal.events()) >= 300
                begun.set()

    reader = threading.Thread(target=read)
    reader.start()
    begun.wait()
    journal.close()
    reader.join()
"""


def test_closing_waits_for_other_threads(tmp_path: Path) -> None:
    done = subprocess.run([sys.executable, "-c", PROGRAM, str(tmp_path)], check=False)
    assert done.returncode == 0
