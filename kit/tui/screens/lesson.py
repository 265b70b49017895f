"""A lesson on the full screen: the picture first, the words below or beside it, what is asked and what works now in sight."""

from __future__ import annotations

import os
import time
from asyncio import to_thread
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from textual.app import ComposeResult
from textual.containers import Container

from kit.dialogue.dialogue import Dialogue, Panel
from kit.dialogue.effects import Remark
from kit.document.blocks import Block, Marked, Picture, Text, Tone, ToneText, labelled_table
from kit.document.glyphs import diagram_lines
from kit.document.layout import Page, place, rows_of
from kit.document.rows import MARGIN, Row, at_both_edges, row, row_width, text_width
from kit.inspection.sockets import sockets_folder
from kit.run.scenario import find_scenario
from kit.school.lessons.aside import has_easy_editor, plain_lines
from kit.school.lessons.defence_dialogue import DefenceDialogue
from kit.school.lessons.exercise_work import ExerciseAttempt
from kit.school.lessons.glossary import lesson_words
from kit.school.lessons.lesson_dialogue import Drive, Edit, EditHere, LessonDialogue, Replay, RunCommand
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.records import LearningScene, LessonStep, StepKind
from kit.school.lessons.shell_lines import shell_path
from kit.school.lessons.training_curves import CURVE_ROWS, ROOMY_CURVE_ROWS
from kit.tui.input.drive import DriveState
from kit.tui.input.drive_keys import base_key, named
from kit.tui.input.driver import key_driver
from kit.tui.input.key_parser import KeyRepeated
from kit.tui.input.screen import DriveScreen
from kit.tui.rows import lesson_rows
from kit.tui.rows.key_rows import FOOTER_ROWS, key_row
from kit.tui.screens.defence import DefenceScreen
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.dialogue import DialogueScreen
from kit.tui.suspend import edit_aside, run_aside
from kit.tui.theme import Theme
from kit.tui.widgets.lesson_page import (
    LEAST_ASIDE,
    ROOMY_SIZE,
    FileColumns,
    LessonContent,
    LessonPage,
    PageLayout,
    words_beside,
)
from kit.tui.widgets.lesson_scene_view import LessonSceneView
from kit.tui.widgets.playback_scene_view import PlaybackSceneView
from kit.tui.widgets.text_rows import TextRows
from kit.tui.widgets.world_view import ErrorEvent
from kit.workspace import Workspace
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from kit.run.recording import Recording
    from kit.run.scenario import Scenario
    from kit.tui.widgets.program_editor import ProgramEditor

ARROWS: Final = ("up", "down", "left", "right")
HELD: Final = (*ARROWS, "pageup", "pagedown", "space")
"""Keys that do more the longer they are held."""
MOST_DRAWN: Final = 10
"""Rows of a picture of a check that is shown at once, as many as a step's own has; `w` shows longer ones."""
MOST_PRINTED: Final = 7
"""Rows of what the program printed; `u` shows all."""
EDITING: Final = "-editing"
"""The screen's class while the editor is open."""
EDITING_BESIDE: Final = "-editing-beside"
"""Its class while the editor is not below the task."""
WIDEST_EDITOR: Final = 100
"""Columns of the editor, beside the task or below it."""
EDITOR_KEYS: Final = (
    ("Ctrl-S", "in the kit's own editor: save, and check"),
    ("Ctrl-Z Ctrl-Y", "there: undo, redo"),
    ("Ctrl-X Ctrl-V", "there: cut, paste; shift with the arrows selects"),
    ("Esc", "there: back to the task; the editor stays open"),
)
ROWS_AROUND: Final = 2 + FOOTER_ROWS
"""Rows of the two headings and of the keys."""
HIGH: Final = 45
"""Rows of a screen with room for all steps of a lesson."""
LEAST_STEPS: Final = 2
"""Steps that are listed at least: the one before that where one is, and that."""
BREAKPOINTS = [(0, "-usual"), (130, "-wide")]


class ScenePair:
    """The stage on the full screen: a world, or tables and messages that are played back; one of them is seen at a time."""

    is_described: Final = False
    is_roomy = False

    def __init__(self, world: LessonSceneView, playback: PlaybackSceneView) -> None:
        self.world = world
        self.playback = playback
        self._is_played_back = False

    @property
    def scene(self) -> LessonSceneView | PlaybackSceneView:
        """The one that is shown."""
        return self.playback if self._is_played_back and not self.world.is_recorded else self.world

    @property
    def is_open(self) -> bool:
        return self.scene.is_open

    @property
    def is_resting(self) -> bool:
        return self.scene.is_resting

    @property
    def is_recorded(self) -> bool:
        return self.world.is_recorded

    @property
    def is_paused(self) -> bool:
        return self.playback.is_paused

    def open(self, step: LessonStep, *, still: bool) -> None:
        self._is_played_back = step.playback_scene is not None
        if step.scene is not None:
            self.world.open(step.scene, still=still)
        else:
            self.world.close_session()
        if step.playback_scene is not None:
            self.playback.open(step.playback_scene, still=still)
        else:
            self.playback.close_session()

    def play(self, recording: Recording, place: Scenario, *, still: bool = False) -> None:
        self.world.play(recording, place, still=still)

    def learn(self, scene: LearningScene) -> None:
        self.world.close_session()
        self._is_played_back = True
        self.playback.open(scene, still=False)

    def go(self) -> None:
        self.scene.go()

    def replay(self) -> None:
        self.scene.replay()

    def set_paused(self, paused: bool) -> None:
        self.scene.set_paused(paused)

    def step_once(self) -> None:
        self.playback.step()

    def close(self) -> None:
        self.world.close_session()
        self.playback.close_session()


LEAST_BACKDROP: Final = 8
"""Rows from which on a small screen has the lesson's last world beside words that leave them free."""


class LessonScreen(DialogueScreen, DriveScreen):
    """Shows one lesson, step by step. Redraws only what a key, a scene or a check has changed."""

    dialogue: LessonDialogue
    DEFAULT_CSS = """
    LessonScreen { layout: vertical; }
    LessonScreen #heading, LessonScreen #title, LessonScreen #keys { height: 1; }
    LessonScreen #file, LessonScreen #status { height: auto; }
    LessonScreen #workplace { height: 1fr; layout: vertical; }
    LessonScreen ProgramEditor { display: none; width: 1fr; max-width: 100%; height: 1fr; }
    LessonScreen.-editing ProgramEditor { display: block; }
    LessonScreen.-editing-beside #workplace { layout: horizontal; }
    """
    HORIZONTAL_BREAKPOINTS = BREAKPOINTS

    def __init__(self, theme: Theme, session: LessonSession, workspace: Workspace) -> None:
        DriveScreen.__init__(self, theme.terminal)
        self.take(LessonDialogue(session))
        self.theme = theme
        self.workspace = workspace
        world = LessonSceneView(theme, workspace.controllers, sockets_folder(workspace.folder))
        self.stage = ScenePair(world, PlaybackSceneView(theme))
        self._page = LessonPage(self.stage.world, self.stage.playback)
        self._strength = 1.0
        self._editor: ProgramEditor | None = None
        self._passed_work: ExerciseAttempt | None = None
        """What passed last."""
        self._passed_at = 0.0
        """When its line began to move."""
        self._said_row = self._look_row = 0
        """Rows of the words in which what was said begins, and what was said last; 0: nothing was."""
        self._code_width: tuple[tuple[str, int], int] = (("", 0), 0)
        """Columns that the code of a step's text needs on a page, for which both are known."""
        self._backdrop = ""
        """What the world beside the words is, where it only stands there."""

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        yield TextRows(id="title")
        with Container(id="workplace"):
            yield self._page
        yield TextRows(id="file")
        yield TextRows(id="status")
        yield TextRows(id="keys")

    def on_mount(self) -> None:
        self.dialogue.begin(self.stage)
        self.show()

    def on_screen_resume(self) -> None:
        self._hold_scene(False)
        self.stage.scene.draw()
        self.show()

    def on_screen_suspend(self) -> None:
        self._hold_scene(True)

    def _hold_scene(self, held: bool) -> None:
        """Has the scene stand still while something else is looked at, or go on if it was going."""
        self.stage.set_paused(held or self.dialogue.is_still)

    # What is shown

    def show(self) -> None:
        width, dialogue = self.room.width, self.dialogue
        if not self.is_attached:
            return
        self._show_editor()
        step, work, layout = dialogue.step, dialogue.work, self._layout
        file = (
            lesson_rows.file_rows(shell_path(work.edited_file), work.by_hand, work.has_others, width)
            if work is not None and not self._is_editing  # it names the file itself
            else []
        )
        status = self._status_rows() if self._has_status_row else []
        self._rows("file").show_all(file)
        self._rows("status").show_all(status)
        self._rows("heading").show([lesson_rows.heading(dialogue.session.lesson_progress, step, width)])
        words = self._word_rows()
        # With the empty row before it.
        answer = max((len(self._placed_rows(each)) + 1 for each in dialogue.possible_answers()), default=0)
        is_roomy = layout is PageLayout.ROOMY
        self.stage.is_roomy = is_roomy
        hides_work = dialogue.has_ended or (self.stage.is_recorded and not is_roomy)
        drawn = [] if hides_work else self._work_picture(self._width - 2, is_roomy=is_roomy)
        asked = dialogue.prediction_blocks()
        question = [row(), *self._placed_rows(asked)] if asked else []
        shown = () if hides_work else tuple(drawn or diagram_lines(step.picture.splitlines()))
        room = self.room.height - ROWS_AROUND - len(file) - len(status)
        most_words = self._said_row + answer
        if is_roomy and most_words + len(question) + len(shown) <= room:
            # What is said to the answer stands below the question, and neither moves.
            most_words += len(question)
            words, question = [*words[: self._said_row], *question, *words[self._said_row :]], []
        has_work = work is not None and not work.by_hand and (is_roomy or not self._is_editing)
        lines = work.edited_lines() if work is not None and has_work else ()
        moves = self.stage.scene if dialogue.has_scene and (is_roomy or not drawn) else None
        blank = 0 if lines or is_roomy else room - most_words - len(question) - len(shown)
        has_room = moves is None and (is_roomy or blank >= LEAST_BACKDROP)
        self._backdrop = self._open_backdrop(has_file=bool(lines)) if has_room else ""
        self._show_title()
        content = LessonContent(
            words,
            question,
            shown,
            moves=self.stage.world if self._backdrop else moves,
            # Not all at once, where there is little room.
            moves_rows=blank if self._backdrop else self._playback_rows,
            first_words=max(self._said_row, answer, len(words) - self._said_row),
            most_words=most_words,
            words_width=self._width,
            step_rows=self._said_row,
            scrolls_with="Esc, down" if self._is_writing else "PgDn" if dialogue.is_driving else "down",
            file=self._numbered(lines) if lines else (),
            file_title=work.edited_file.name if work is not None and has_work else "",
            file_line=work.line_to_show - 1 if work is not None and has_work else 0,
            file_columns=self._file_columns,
            is_at_file=dialogue.is_at_code,
            panels=self._panels(),
            page_width=width,
            aids=self._aids() if lines and is_roomy else (),
        )
        self._page.show(content, room - self._editor_rows(room), layout)
        dialogue.is_code_cut = has_work and self._page.is_file_cut
        self._show_keys()

    def _open_backdrop(self, *, has_file: bool) -> str:
        """Opens a world that stands still beside the words, where there is one, and says which it is: the one in which the
        exercise's program will drive, or for a step without anything that moves the one that was driven in last."""
        work, step = self.dialogue.work, self.dialogue.step
        scene = work.scene if has_file and work is not None else None
        caption = "where your program drives, before its start"
        if step.exercise is None and step.graph is None and not self.dialogue.has_ended:
            before = self.dialogue.session.lesson.steps[: step.number - 1]
            last = next((each for each in reversed(before) if each.scene is not None), None)
            if last is not None:
                scene, caption = last.scene, f"the world of step {last.number}, before its start"
        if scene is None:
            return ""
        if self.stage.world.scene != scene:
            self.stage.world.open(scene, still=True)
        return caption

    def _panels(self) -> list[Panel]:
        """What a large screen has besides: the lesson's steps, what the check of this one looks at, until it has where there is
        little room, and the words that the lesson introduces."""
        if self._is_editing or PageLayout.of(*self.room, is_wide=True) is not PageLayout.ROOMY:
            return []
        progress = self.dialogue.session.lesson_progress
        lesson, here = progress.lesson, None if self.dialogue.has_ended else self.dialogue.step
        first = 0
        if (
            here is not None and self.room.height < HIGH
        ):  # where not all may have room, it begins shortly before that
            first = max(0, min(here.number - 2, len(lesson.steps) - LEAST_STEPS))
        panels = [Panel("steps", (lesson_rows.steps_table(progress, here, first),))]
        work, columns = self.dialogue.work, self._file_columns
        is_kept = columns is not None and columns.aside > 0  # so that nothing below it moves
        if work is not None and work.criteria and not work.by_hand and (work.report is None or is_kept):
            rows = [(title, ToneText(f"{points:g}", Tone.DIM)) for title, points in work.criteria]
            panels.append(Panel("what is checked, and its points", (labelled_table(rows, is_tight=True),)))
        with suppress(WorldError, FileNotFoundError):  # it is told where the glossary is opened
            panels += [Panel("words", words)] if (words := lesson_words(lesson.name)) else []
        return panels

    def _aids(self) -> list[Panel]:
        """What is shown below a file that leaves room: what the program printed, and the step to read before it."""
        work, here = self.dialogue.work, self.dialogue.step
        panels = []
        if work is not None and (printed := work.printed_lines):
            panels.append(Panel("what it printed", (Picture(tuple(printed[-MOST_PRINTED:]), indent=0),)))
        before = self.dialogue.session.lesson.steps[: here.number - 1]
        read = next((each for each in reversed(before) if each.kind is StepKind.EXPLAIN), None)
        if read is not None:
            told: tuple[Block, ...] = (
                *Picture.of_diagram(read.picture.splitlines()),
                Marked(self.dialogue.with_paths(read.text)),
            )
            panels.append(Panel(f"step {read.number}: {read.title}", told))
        return panels

    def _numbered(self, lines: Sequence[str]) -> list[list[Row]]:
        """The student's file in colours, with the numbers of its lines, and below a line that the check names what is wrong."""
        from kit.tui.widgets.program_colours import LANGUAGES, coloured_rows  # of no use to the first frame

        work, digits = self.dialogue.work, len(str(len(lines)))
        language = None if work is None else LANGUAGES.get(work.edited_file.suffix)
        numbered = [
            [row((f"{number:>{digits}} ", "dim"), *line)]
            for number, line in enumerate(coloured_rows(lines, language), 1)
        ]
        if work is not None and work.seconds is None and 0 < work.error_line <= len(lines):
            blank = " " * (digits + work.error_column)
            numbered[work.error_line - 1].append(
                row((f"{blank}^ {work.error_text}".partition("\n")[0], "bad"))
            )
        return numbered

    def _word_rows(self) -> list[Row]:
        """The words of the step, and below them what is said to what the student did."""
        told, said = self.dialogue.step_blocks(), self.dialogue.reply_blocks()
        placed = place([*told, *said], self._page_of_words)
        starts = [start + 1 for start in placed.starts]
        self._said_row = starts[len(told)] - 1 if said else len(placed.rows) + 1
        look = self.dialogue.block_in_view
        self._look_row = starts[len(told) + said.index(look)] if look is not None else 0
        return [row(), *placed.rows]

    def _placed_rows(self, blocks: list[Block]) -> list[Row]:
        return rows_of(blocks, self._page_of_words)

    @property
    def _page_of_words(self) -> Page:
        is_beside = self._layout is not PageLayout.STACKED
        return Page(text_width(self._width), MARGIN, is_beside=is_beside)

    def _show_title(self) -> None:
        width, caption = self.room.width, self._caption()
        if self.dialogue.has_ended:
            title = at_both_edges((), caption, width)
        else:
            title = lesson_rows.title(self.dialogue.step, caption, width)
        self._rows("title").show([title])

    def _caption(self) -> Row:
        """The state of the scene, or what is said to the last key, if that has no row of its own."""
        dialogue, scene, remark = self.dialogue, self.stage.scene, self.turn.remark
        if remark is not None and not self._has_status_row:
            return row((remark.text, remark.tone))
        state = self._backdrop
        if dialogue.has_scene:
            state = scene.caption
            if dialogue.is_waiting and scene.is_open:
                state = "waiting for your prediction"
            elif scene.by_hand and scene.is_open:
                state = "you drive" if dialogue.is_driving else "press d to drive"
        return row((state, "dim"))

    @property
    def _has_status_row(self) -> bool:
        """Whether what is said to the last key has a row of its own: in an exercise, and where it would cut the step's title."""
        dialogue, remark = self.dialogue, self.turn.remark
        if dialogue.work is not None or dialogue.note is not None:
            return True
        return (
            remark is not None
            and not dialogue.has_ended
            and not lesson_rows.fits_beside_title(
                dialogue.step, row((remark.text, remark.tone)), self.room.width
            )
        )

    def _status_rows(self) -> list[Row]:
        """Where one is with the exercise, in one row, or what is said to the last key, in as many as it needs."""
        work, remark = self.dialogue.work, self.turn.remark
        if work is not None and work.seconds is not None:
            return [lesson_rows.checking(work.seconds, work.progress, self.room.width)]
        since = time.monotonic() - self._passed_at
        if work is self._passed_work and since < lesson_rows.PASSED_S and remark is None:
            return [lesson_rows.passing(since)]
        if remark is None:
            return [self._remark()]
        return rows_of([Text(remark.text, remark.tone)], Page(self.room.width - 2 * MARGIN, MARGIN))

    def _work_picture(self, width: int, *, is_roomy: bool = False) -> list[str]:
        """What the student's work does, in characters: the curves of its trainings as they grow, and the robot with the newest
        policy (where motion is reduced, once they are whole), or what a check drew of it, such as the way of a perfect learner."""
        work = self.dialogue.work
        if work is None or (work.seconds is not None and self.theme.terminal.reduce_motion.value):
            return []
        curves = work.training_curves
        if curves is not None:
            rows = ROOMY_CURVE_ROWS if is_roomy else CURVE_ROWS
            return curves.picture(width, self.theme.encoder, *work.training_drive(), rows)
        lines = [] if work.seconds is not None else work.picture_lines
        drawn = [line if len(line) <= width else f"{line[: width - 3]}..." for line in lines]
        return drawn if len(drawn) <= MOST_DRAWN else []

    @property
    def _width(self) -> int:
        """Width of the words."""
        width = self.room.width - self._editor_width
        if self._layout is PageLayout.STACKED:
            return width
        if (columns := self._file_columns) is not None:
            return columns.words
        dialogue, usual = self.dialogue, words_beside(width)
        if dialogue.has_scene or dialogue.step.exercise is not None:
            return usual
        drawn = max(map(len, dialogue.step.picture.splitlines()), default=0) + 2 * MARGIN + 1
        return max(usual, min(max(self._code_columns(width), drawn), width - LEAST_ASIDE))

    @property
    def _file_columns(self) -> FileColumns | None:
        """The columns of a page that shows the student's file beside the words; None: this one does not."""
        work = self.dialogue.work
        if work is None or work.by_hand or self._layout is not PageLayout.ROOMY:
            return None
        lines = work.edited_lines()
        longest = max(map(len, lines), default=0) + len(f"{len(lines)} ")
        picture = max(map(len, self.dialogue.step.picture.splitlines()), default=0)
        return FileColumns.of(self.room.width, longest, picture + 2 * MARGIN)

    def _code_columns(self, width: int) -> int:
        """Columns that the step's words need for none of their lines of code to be broken, on a page of so many."""
        key = self.dialogue.step.text, width
        if self._code_width[0] != key:
            rows = rows_of(self.dialogue.step_blocks(), Page(width, MARGIN))
            code = (each for each in rows if any(text.strip() for text, _ in each))
            needed = (
                row_width(each)
                for each in code
                if all(style == Tone.CODE for text, style in each if text.strip())
            )
            self._code_width = key, max(needed, default=0) + 2 * MARGIN
        return self._code_width[1]

    @property
    def _playback_rows(self) -> int:
        """Rows that what is played back has a use for; 0: nothing is, and a scene takes the rows that there are."""
        is_played = self.dialogue.has_scene and self.stage.scene is self.stage.playback
        return self.stage.playback.rows if is_played else 0

    @property
    def _layout(self) -> PageLayout:
        if (
            self._playback_rows or self._is_editing
        ):  # it is low and as wide as the screen, or the editor stands there
            return PageLayout.STACKED
        return PageLayout.of(self.room.width, self.room.height, is_wide=self.has_class("-wide"))

    def show_all(self) -> None:
        """Shows everything, and brings what was just said into sight."""
        self.show()
        if not self._look_row:
            self._page.scroll_words_to(0)
            return
        self._page.scroll_words_to(self._said_row)
        self._page.scroll_words_into_sight(self._look_row)

    def look_again(self) -> None:
        self.show()  # the words stay where they were scrolled to

    # What moves

    def on_playback_scene_view_updated(self) -> None:
        self.on_lesson_scene_view_moved()

    def on_lesson_scene_view_moved(self) -> None:
        if not self.is_active:
            return
        if self.stage.is_resting and self.dialogue.on_scene_end():
            self.show_all()
        self._show_title()

    def on_error_event(self, event: ErrorEvent) -> None:
        self.app.push_screen(MessageDialog("The scene cannot be shown", event.text))
        if self.dialogue.on_scene_end():
            self.show_all()

    def _poll(self) -> None:
        work, is_checking = self.dialogue.work, bool(self.dialogue.busy)
        if not self.dialogue.polls or not (self.is_active or is_checking):
            return
        is_read_anew = work is not None and work.reads_anew()
        is_checked_elsewhere = bool(self.dialogue.checked_elsewhere)
        super()._poll()
        if is_checking and not self.dialogue.busy and work is not None and work is self.dialogue.work:
            self._celebrate(work)
        if self._editor is not None and self._is_editing:
            self._editor.follow_file()
        if is_read_anew or is_checked_elsewhere:
            self.show()

    def _celebrate(self, work: ExerciseAttempt) -> None:
        """Lets the line of a check that has passed move once, unless motion is reduced."""
        if work.report is not None and work.report.is_passed:
            # Its run is seen in place of the code, where that has no place of its own.
            self.dialogue.is_at_code = False
        if work.report is None or not work.report.is_passed or self.theme.terminal.reduce_motion.value:
            return
        self._passed_work, self._passed_at = work, time.monotonic()
        count = lesson_rows.PASSED_CELLS + 1
        self.set_interval(lesson_rows.PASSED_S / lesson_rows.PASSED_CELLS, self._show_status, repeat=count)
        self._show_status()

    def _show_status(self) -> None:
        if self.is_active and self.dialogue.work is not None:
            self._rows("status").show_all(self._status_rows())

    # Keys

    def takes_key(self, key: str) -> bool:
        return not self._is_writing and not self.is_drive_key(key)

    def is_drive_key(self, key: str) -> bool:
        return not self._is_writing and self.dialogue.is_driving and base_key(key) in ARROWS

    def drive_keys_changed(self, messages: tuple[str, ...], state: DriveState) -> None:
        strength = max((push for name, push in state.held.items() if named(name).moves), default=1.0)
        if (messages or strength != self._strength) and self.dialogue.is_driving:
            self.stage.world.press(messages, strength)
        self._strength = strength

    def on_key_repeated(self, event: KeyRepeated) -> None:
        """A key that is held scrolls and drives; it does not go on and on."""
        if not self.is_drive_key(event.key) and base_key(event.key) not in HELD:
            event.prevent_default()

    def action_scroll(self, lines: int) -> None:
        self._page.scroll(lines)

    # What is shown beside the lesson

    @property
    def help_notes(self) -> Sequence[Sequence[tuple[str, str]]]:
        return (*super().help_notes, *((EDITOR_KEYS,) if self.dialogue.can_edit() else ()))

    def screen_for(self, dialogue: Dialogue) -> DialogueScreen:
        if isinstance(dialogue, DefenceDialogue):
            return DefenceScreen(dialogue, self.theme, self.workspace)
        return super().screen_for(dialogue)

    async def show_request(self, request: object) -> Any:
        match request:
            case Edit(file, line):
                if has_easy_editor(os.environ):
                    return edit_aside(self.app, file, line, self.theme.terminal)
                return self._edit_here(file, line)
            case EditHere(file, line):
                return self._edit_here(file, line)
            case RunCommand():
                return self._run_command(request)
            case Drive():
                return await self._drive(request)
            case Replay(file):
                return await self._replay(file)
        return await super().show_request(request)

    # The editor

    @property
    def _is_editing(self) -> bool:
        """Whether the editor is shown."""
        return self.has_class(EDITING)

    @property
    def _is_writing(self) -> bool:
        """Whether keys are letters of the program."""
        return self._editor is not None and self._editor.area.has_focus

    @property
    def _editor_width(self) -> int:
        """Columns of the editor beside the task; 0 where it is below it or not shown."""
        width = self.room.width
        return min(WIDEST_EDITOR, width - LEAST_ASIDE) if self._is_editing and width >= ROOMY_SIZE[0] else 0

    def _editor_rows(self, room: int) -> int:
        """Rows of the editor below the task, of ``rows``; 0 where it is beside it or not shown."""
        return room // 2 if self._is_editing and not self._editor_width else 0

    def _edit_here(self, file: Path, line: int) -> str:
        """Opens a file in the editor, at a line; says why that is not possible."""
        from kit.tui.widgets.program_editor import (  # of no use to the first frame
            ProgramEditor,
            ProgramFile,
            ProgramFileError,
        )

        if self._editor is None or self._editor.program.file != file or not self._is_editing:
            try:
                if self._editor is None:
                    self._editor = ProgramEditor(ProgramFile(file))
                    self.query_one("#workplace").mount(self._editor)
                else:
                    self._editor.open(file)
            except ProgramFileError as error:
                return str(error)
        self.add_class(EDITING)
        self.call_after_refresh(self._write_at, line)
        return ""

    def _write_at(self, line: int) -> None:
        if self._editor is not None:
            self._editor.area.focus()
            self._editor.go_to_line(line)
            self.show()

    def _show_editor(self) -> None:
        """Closes the editor where its file is not the step's, gives it its place, and marks the line that the check names."""
        work, editor = self.dialogue.work, self._editor
        self.set_class(self._editor_width > 0, EDITING_BESIDE)
        if editor is None or not self._is_editing:
            return
        if work is None or self.dialogue.has_ended or work.edited_file != editor.program.file:
            self._close_editor()
            return
        height = self.room.height - ROWS_AROUND - 1
        editor.styles.height = self._editor_rows(height) or "1fr"
        editor.styles.width = self._editor_width or "1fr"
        line = 0 if work.seconds is not None else work.error_line
        editor.show_problem(line or None, work.error_text if line else "")

    def _close_editor(self) -> None:
        if self._editor is not None and (problem := self._editor.keep_draft()):
            self.turn.set_remark(Remark(f"What you typed is {problem}", Tone.BAD))
        self.remove_class(EDITING)
        self.set_focus(None)

    def action_editor(self) -> None:
        """Closes the editor, from within it."""
        self._close_editor()
        self.show()

    def action_save_program(self) -> None:
        if self._editor is not None and self._is_editing:
            self._editor.save()

    def on_program_saved(self) -> None:
        """Saving checks: the file is looked at as if another editor had saved it."""
        self._poll()

    def on_editor_left(self) -> None:
        self.set_focus(None)

    def on_descendant_focus(self) -> None:
        self._report_releases(False)
        self._take_writing()

    def on_descendant_blur(self) -> None:
        self._report_releases(bool(self.theme.terminal.ask_keyboard.value))
        self._take_writing()

    def _take_writing(self) -> None:
        """Has the words name the keys that work from now on."""
        self.dialogue.is_writing = self._is_writing
        self.show()

    def _report_releases(self, wanted: bool) -> None:
        driver = key_driver(self.app)
        if driver is not None:
            driver.report_releases(wanted)

    def _show_keys(self) -> None:
        keys = key_row(
            ("^S", "save and check"),
            ("Esc", "task"),
            ("^Z", "undo"),
            ("^Y", "redo"),
            ("^E", "close"),
            ("^P", "find"),
        )
        self._rows("keys").show([keys if self._is_writing else self._keys()])

    def _run_command(self, request: RunCommand) -> str | None:
        self._hold_scene(True)
        printed = run_aside(
            self.app,
            request.line,
            self.theme.terminal,
            workspace=self.workspace.folder,
            folder=request.folder,
            waits=request.waits,
        )
        self._hold_scene(False)
        return printed and "\n".join(plain_lines(printed))

    async def _drive(self, request: Drive) -> str | None:
        from kit.run.recording_file import RecordingFile  # of no use to the first frame, as what follows
        from kit.tui.screens.lesson_drive import RecordedDriveScreen

        try:
            kept = RecordingFile(request.file)
        except OSError as error:
            return f"{request.file}: {error.strerror}." if error.strerror else str(error)
        drive = RecordedDriveScreen(self.theme, request.scene, kept, self.workspace)
        await self.app.push_screen_wait(drive)
        return drive.problem or ("" if drive.was_kept else None)

    async def _replay(self, file: Any) -> str:
        from kit.tui.screens.lesson_drive import RecordingScreen  # of no use to the first frame

        try:
            recording, place = await to_thread(_load, file)
        except Exception as error:  # noqa: BLE001 - a recording, a world or a disk that is not as it should be
            return str(error)
        await self.app.push_screen_wait(RecordingScreen(self.theme, place, recording, "your last run"))
        return ""


def _load(file: Any) -> tuple[Recording, Scenario]:
    """Loads a recording and its scenario, in another thread: the physics takes a moment to import."""
    from kit.run.recording import load_recording

    recording = load_recording(file)
    return recording, find_scenario(recording.place, recording.case)
