"""The kit's app on a lesson of the tests: ``lesson_app.py LESSONS SOLUTIONS WORKSPACE [--glyphs ascii]``."""

import os
import sys
from pathlib import Path

from kit.cli import terminal_options

terminal = terminal_options.decide(glyphs=sys.argv[5] if len(sys.argv) > 5 else None)
os.environ.update(terminal.environment())

from kit.school.lessons import checking  # noqa: E402 - as the kit itself does it
from kit.school.lessons.lesson_session import LessonSession  # noqa: E402 - likewise
from kit.school.lessons.reading import read_lesson  # noqa: E402 - likewise
from kit.school.progress import ProgressJournal  # noqa: E402 - likewise
from kit.tui.app import KitApp  # noqa: E402 - likewise
from kit.tui.screens.lesson import LessonScreen  # noqa: E402 - likewise
from kit.workspace import open_workspace  # noqa: E402 - likewise

lessons, solutions, folder = map(Path, sys.argv[1:4])
checking.solutions_folder = lambda: solutions  # type: ignore[assignment]  # another folder, for this program alone
workspace = open_workspace(folder)
with ProgressJournal(workspace.folder) as progress:
    app = KitApp(terminal)
    app.begin(
        LessonScreen(
            app.kit_theme, LessonSession(read_lesson(lessons / "01-colours"), progress, workspace), workspace
        )
    )
    app.run()
sys.exit(app.return_code or 0)
