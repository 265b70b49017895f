"""A dialogue line by line: for screen readers, pipes, and terminals without a full screen."""

from __future__ import annotations

import inspect
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

import click

from kit.cli import messages, opening, options, terminal_options
from kit.cli.full_screen import show_dialogue
from kit.cli.input_lines import InputBuffer, InputLines
from kit.dialogue.dialogue import Dialogue, DialogueAction, Turn
from kit.dialogue.effects import Choose, Effect, Help, Leave, Open, Remark, Show, StartTyping, Tell, Work
from kit.document.blocks import Block, Text, labelled_table
from kit.document.layout import HEARD, lines_of
from kit.plain_text import wrap

POLL_S: Final = 0.2
"""Seconds between two looks whether something has happened by itself."""
NOT_TYPED: Final = ("Esc", "Enter")
"""Keys that are no sign in a line; another key of the same action is named there, if it has one."""

REPEAT_KEYS: Final = ("t", "text")
"""What says everything of a place again, in every dialogue; a screen shows it all the time."""

Way = Callable[[Any, InputBuffer], Any]
"""Shows what a dialogue asks a face to show, reading lines from the same input; returns what came of it."""
NO_WAYS: Final[Mapping[type, Way]] = MappingProxyType({})


def run_dialogue(
    dialogue: Dialogue, ways: Mapping[type, Way] = NO_WAYS, input_buffer: InputBuffer | None = None
) -> None:
    """Asks line by line until the dialogue is over, is left, or the input ends. ``ways``: by class of request."""
    buffer = InputBuffer() if input_buffer is None else input_buffer
    lines = InputLines(lambda: None, buffer)
    try:
        _Conversation(dialogue, lines, buffer, ways).run()
    finally:
        lines.close()


def dialogue_command(name: str, make: Any) -> click.Command:
    """A verb that opens a dialogue of another package, on the screen or line by line. ``make``: of a Workspace."""

    @click.command(name, help=inspect.getdoc(make))
    @options.workspace
    @click.option("--plain", is_flag=True, help="Ask line by line instead of on a full screen.")
    @terminal_options.glyphs
    @terminal_options.color
    def command(workspace: Path | None, plain: bool, glyphs: str | None, color: str | None) -> None:
        terminal = terminal_options.decide(plain=plain, glyphs=glyphs, color=color)
        dialogue = make(opening.open_existing_workspace(workspace))
        if terminal.plain.value:
            run_dialogue(dialogue)
        else:
            show_dialogue(dialogue, terminal)

    return command


class _Conversation:
    """One dialogue, driven by lines of text."""

    def __init__(
        self, dialogue: Dialogue, lines: InputLines, buffer: InputBuffer, ways: Mapping[type, Way]
    ) -> None:
        self._dialogue = dialogue
        self._turn = Turn(dialogue)
        self._lines = lines
        self._buffer = buffer
        self._ways = ways
        self._place: object = self  # nothing has been said of any place
        self._said: list[list[str]] = []
        """The blocks of the place as they were said last."""
        self._note: Text | None = None
        self._keys_said: list[str] = []
        self._is_left = False

    def run(self) -> None:
        _print_blocks(self._dialogue.opening())
        try:
            self._show()
            while not (self._is_left or self._dialogue.is_over):
                line = self._read()
                if line is None:
                    break
                self._take(line)
        except KeyboardInterrupt:
            click.echo("")
        finally:
            self._dialogue.close()
            _print_blocks(self._dialogue.farewell())

    # What is said

    def _show(self, *, with_keys: bool = True) -> None:
        """Says what is new, the blocks that were not there before, and then the keys; at another place where that is, and all
        of it."""
        dialogue = self._dialogue
        blocks = dialogue.blocks()
        lines = [lines_of([block]) for block in blocks]
        heard: Sequence[Block] = ()
        if dialogue.place != self._place:
            self._place, heard = dialogue.place, dialogue.arrival_blocks()
            self._said = []  # two questions may have the same words
            click.echo("")
            if dialogue.position:
                _print_lines(wrap(dialogue.position[0].upper() + dialogue.position[1:], HEARD.width))
        new = [block for block, said in zip(blocks, lines, strict=True) if said not in self._said]
        note = dialogue.note
        if note is not None and note != self._note:
            new.append(note)
        _print_blocks([*heard, *new])
        self._said, self._note = lines, note
        if with_keys:
            self._say_keys()

    def _say_keys(self) -> None:
        """The keys that do something now, where they are others than before."""
        if self._dialogue.is_over or self._dialogue.busy:
            return
        keys = [
            f"{_typed_keys(each, self._dialogue)} {_action_word(each, self._dialogue)}"
            for each in self._turn.possible()
            if each.is_for_lines and each.is_listed
        ]
        if keys != self._keys_said:
            self._keys_said = keys
            held = " \0".join(each.replace(" ", "\0") for each in keys)  # a key stays with its word
            _print_lines(["", *(line.replace("\0", " ").strip() for line in wrap(held, HEARD.width))])

    def _say_help(self) -> None:
        rows = [
            (_typed_keys(each, self._dialogue), _action_word(each, self._dialogue), each.keys.help)
            for each in self._turn.possible()
            if each.is_for_lines
        ]
        _print_blocks([labelled_table([*rows, (*REPEAT_KEYS, "say everything here again")])])
        click.echo("Type a key or its word, and Enter.")

    # What is done

    def _read(self) -> str | None:
        """The next line; None at the end of the input. Meanwhile it is looked whether something happens by itself."""
        self._prompt()
        while self._dialogue.polls and not self._lines.wait_for_line(POLL_S):
            self._perform(self._turn.attempt(self._dialogue.poll))
            if self._dialogue.busy:
                click.echo("")
                self._wait_while_busy()
                self._show()
                self._prompt()
        return self._lines.read_line()

    def _prompt(self) -> None:
        if sys.stdin is not None and sys.stdin.isatty():
            click.echo("> ", nl=False)

    def _take(self, line: str) -> None:
        if line.strip().lower() in REPEAT_KEYS and self._turn.find(REPEAT_KEYS[0]) is None:
            self._place, self._said, self._note, self._keys_said = self, [], None, []
            self._show()
            return
        effect, then = self._turn.enter(line)
        self._perform(effect)
        self._wait_while_busy()
        if self._is_left:
            return
        self._show(with_keys=not then)
        if then:
            self._perform(self._turn.do(then))
            if not self._is_left:
                self._show()

    def _wait_while_busy(self) -> None:
        """Waits for what goes on; Ctrl-C ends it. What it is doing is said to a person, a pipe gets the outcome alone."""
        said = ""
        while busy := self._dialogue.busy:
            if busy != said and (not said or sys.stdout.isatty()):
                _print_lines([busy])
                said = busy
            try:
                time.sleep(POLL_S / 4)
                self._perform(self._turn.attempt(self._dialogue.poll))
            except KeyboardInterrupt:
                click.echo("")
                self._perform(self._turn.attempt(self._dialogue.stop))

    def _perform(self, effect: Effect) -> None:
        while effect is not None:
            effect = self._carry_out(effect)

    def _carry_out(self, effect: Effect) -> Effect:
        """Carries an effect out; returns the one that follows."""
        attempt = self._turn.attempt
        match effect:
            case Remark(text):
                _print_lines(wrap(text, HEARD.width))
            case Leave():
                self._is_left = True
            case Help():
                self._say_help()
            case StartTyping():
                click.echo("Type your answer, and Enter.")
            case Tell(_, blocks):
                _print_blocks(blocks)
            case Choose(title, choices, chose):
                click.echo(f"{title}:")
                for number, (name, text) in enumerate(choices, 1):
                    _print_lines(wrap(f"{name}  {text}", HEARD.width, f"  {number}  ", "     "))
                self._prompt()
                line = (self._lines.read_line() or "").strip()
                chosen = int(line) - 1 if line.isdecimal() and 1 <= int(line) <= len(choices) else None
                return attempt(chose, chosen)
            case Open(dialogue, closed):
                _Conversation(dialogue, self._lines, self._buffer, self._ways).run()
                self._place, self._said, self._keys_said = self, [], []
                return attempt(closed)
            case Work(note, job, done):
                _print_lines(wrap(note, HEARD.width) if note else [])
                return attempt(lambda: done(job(click.echo)))
            case Show(request, shown):
                way = self._ways[type(request)]
                return attempt(lambda: shown(way(request, self._buffer)))
        return None


def _typed_keys(action: DialogueAction[Any], dialogue: Dialogue) -> str:
    """The keys of an action as they are typed in a line."""
    if action.shown_keys is not None:
        return action.shown_keys(dialogue)
    shown = action.keys.footer_keys
    typed = [key for key in action.keys.keys.split() if len(key) == 1]
    return typed[0] if shown in NOT_TYPED and typed else shown


def _action_word(action: DialogueAction[Any], dialogue: Dialogue) -> str:
    return action.word(dialogue) if action.word is not None else action.keys.label


def _print_blocks(blocks: Sequence[Block]) -> None:
    """Prints blocks, with an empty line between two that are not tight."""
    _print_lines(lines_of(blocks))


def _print_lines(lines: Sequence[str]) -> None:
    for line in lines:
        click.echo(messages.replace_unencodable(line))
