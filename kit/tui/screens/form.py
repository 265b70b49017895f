"""The evaluation form, opened from another screen."""

from __future__ import annotations

from asyncio import to_thread
from typing import Any

from textual.screen import Screen

from kit.school.form_dialogue import FormDialogue
from kit.school.form_reading import read_form
from kit.school.form_session import FormSession, current_phase
from kit.school.progress import ProgressError, ProgressJournal
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.dialogue import DialogueScreen
from kit.world.problems import WorldError


async def ask_form(screen: Screen[Any], journal: ProgressJournal) -> None:
    """Asks the form where the student stopped, and comes back. To be called in a worker."""
    try:
        form = await to_thread(read_form)
        session = FormSession(form, current_phase(form, journal), journal)
    except (WorldError, FileNotFoundError, ProgressError) as error:
        screen.app.push_screen(MessageDialog("The form cannot be opened", str(error)))
        return
    await screen.app.push_screen_wait(DialogueScreen(FormDialogue(session)))
