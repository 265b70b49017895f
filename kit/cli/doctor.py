"""``kit doctor`` and ``kit keys``: what the kit found here and decided, and what this terminal sends for keys."""

from __future__ import annotations

import json
import os
import platform
import sys
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import click

import kit
from kit.cli import messages, terminal_options
from kit.cli.full_screen import show_screen
from kit.document.blocks import labelled_table
from kit.document.layout import lines_of
from kit.extensions import GROUPS, checked, installed_extensions, name_conflicts
from kit.host.sandbox.probe import probe_levels
from kit.host.sandbox.promises import promises_since
from kit.host.sandbox.sandbox_config import Level
from kit.installation import (
    DISTRIBUTION,
    foreign_distributions,
    install_command,
    installed_version,
    overwritten_text,
    requirements,
)
from kit.kernels.shared_cache import kept_files, shared_folders, unshared_reason
from kit.plain_text import counted
from kit.tui.input.protocol import ask_keyboard
from kit.tui.terminal import TerminalDecision, TerminalFacts, decide_terminal
from kit.workspace import open_workspace

if TYPE_CHECKING:
    from kit.tui.app import KitApp
    from kit.tui.screens.key_test import KeyTestScreen


MEGA: Final = 1e6
GIGA: Final = 1e9
LEARNERS: Final = (1_000, 100_000)
"""Numbers of learners for which the needs before a deadline are simulated."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One line of the report: the subject, what was found, and what that means."""

    section: str
    name: str
    value: str
    meaning: str = ""


def _check_machine() -> Iterator[Finding]:
    yield Finding("Machine", "kit", kit.__version__)
    yield Finding("Machine", "python", platform.python_version(), sys.executable)
    yield Finding("Machine", "system", f"{platform.system()} {platform.release()} {platform.machine()}")
    yield Finding("Machine", "processors", str(os.cpu_count() or "unknown"))


def _check_terminal(decision: TerminalDecision) -> Iterator[Finding]:
    section = "Terminal"
    plain, between = decision.plain, decision.between
    for name in ("TERM", "COLORTERM"):
        yield Finding(section, name, os.environ.get(name) or "not set")
    yield Finding(section, "screen", "plain text" if plain.value else "full screen", plain.reason)
    yield Finding(section, "glyphs", decision.glyphs.value, decision.glyphs.reason)
    yield Finding(section, "colours", decision.colour.value, decision.colour.reason)
    yield Finding(section, "theme", decision.theme_name.value, decision.theme_name.reason)
    yield Finding(section, "size", decision.room.value, decision.room.reason)
    yield Finding(section, "link", "remote" if decision.remote.value else "local", decision.remote.reason)
    yield Finding(section, "in between", between.value or "nothing", between.reason)
    yield _check_keyboard(decision)
    motion = "reduced" if decision.reduce_motion.value else "full"
    yield Finding(section, "motion", motion, decision.reduce_motion.reason)
    mouse = "the kit's" if decision.mouse.value else "the terminal's"
    yield Finding(section, "mouse", mouse, decision.mouse.reason)
    if decision.remote.value:
        yield Finding(
            section,
            "tip",
            "ssh -C",
            "Compression cuts the data sent to about an eighth: `ssh -C HOST`.",
        )


def _check_keyboard(decision: TerminalDecision) -> Finding:
    name = "key release"
    if decision.plain.value:
        return Finding("Terminal", name, "not asked", "Plain mode reads lines, not keys.")
    if not decision.ask_keyboard.value:
        return Finding("Terminal", name, "not asked", decision.ask_keyboard.reason)
    try:
        report = ask_keyboard(sys.stdin.fileno(), sys.stderr.fileno())
    except OSError as error:
        return Finding("Terminal", name, "not asked", f"Cannot query the terminal: {error.args[-1]}.")
    if report.seconds is None:
        return Finding(
            "Terminal",
            name,
            "no answer",
            "The terminal did not answer within a second. The robot drives while a key repeats.",
        )
    took = f"Answered in {1000 * report.seconds:.0f} ms"
    if report.releases:
        return Finding(
            "Terminal",
            name,
            "reported",
            f"{took}, flags {report.flags}. The robot drives while a key is down.",
        )
    who = decision.between.value or "This terminal"
    flags = "" if report.flags is None else f", flags {report.flags}"
    return Finding(
        "Terminal",
        name,
        "not reported",
        f"{took}{flags}. {who} does not pass them on: the robot drives while a key repeats, or until another key.",
    )


def _check_packages() -> Iterator[Finding]:
    """Finds which of the declared packages are installed. Imports none of them: torch alone takes seconds."""
    for name, its_version in foreign_distributions():
        yield Finding("Packages", name, its_version, overwritten_text(name, its_version))
    declared = requirements()
    if not declared:
        yield Finding(
            "Packages", DISTRIBUTION, "not installed", "The kit runs from a folder: pip install -e FOLDER."
        )
        return
    for name in declared:
        found = installed_version(name)
        yield Finding("Packages", name, found or "missing", "" if found else "Install the kit again.")
    learning = {name: installed_version(name) for name in requirements("learn")}
    for name, found in learning.items():
        yield Finding("Learning", name, found or "missing")
    if None in learning.values():
        yield Finding(
            "Learning",
            "in all",
            "incomplete",
            "Driving, controllers, worlds, layers and grading work; training does not. "
            f"To have it, type: {install_command('learn')}",
        )


def _check_extensions() -> Iterator[Finding]:
    """Finds the parts that other packages bring, and tries each."""
    if not installed_extensions():
        return  # nothing heavy is imported to compare names with
    own = own_names()
    left_out = {each: why for group in GROUPS for each, why in name_conflicts(group, own[group])}
    for each in installed_extensions():
        name = f"{each.group.removesuffix('s')} {each.name}"
        problem = f"Left out: {left_out[each]}." if each in left_out else checked(each)
        yield Finding("Parts of other packages", name, each.source, problem or "Works.")


def own_names() -> dict[str, tuple[str, ...]]:
    """The names in each group that the kit itself uses, which no other part may have."""
    from kit.cli import VERBS
    from kit.sim.plugins import plugin_types, world_plugin_types

    verbs = tuple(VERBS)
    devices = (*plugin_types, *world_plugin_types)
    return {**dict.fromkeys(GROUPS, ()), "verbs": verbs, "dialogues": verbs, "devices": devices}


def _check_confinement() -> Iterator[Finding]:
    """Finds which confinement levels this machine has, and what each keeps a program from. One's own runs at 0."""
    for support in probe_levels():
        value = "available" if support.is_available else "not available"
        reason = support.reason[:1].upper() + support.reason[1:].removesuffix(".") + "."
        yield Finding("Student code", f"level {support.level}", value, reason)
    for level in (*Level, None):
        name = "not prevented" if level is None else f"from level {level:d} on"
        actions = "; ".join(promise.action for promise in promises_since(level))
        meaning = "At level 0 this only prevents accidents." if level is Level.LIMITED else ""
        yield Finding("Student code cannot", name, f"{actions}.", meaning)


def _check_kernels() -> Finding:
    """Finds whether all accounts share what is compiled for this machine."""
    folder = shared_folders()[0]
    section, name, made = "Compiled kernels", "for all accounts", "sudo kit warm --shared"
    if not folder.is_dir() or not any(kept_files(folder)):
        return Finding(
            section, name, "none", f"Each account compiles for itself. To have them for all: {made}"
        )
    if problem := unshared_reason(folder):
        return Finding(section, name, "not used", f"{problem}. To make them anew: {made}")
    return Finding(section, name, str(folder), "Accounts without kernels of their own use them.")


def _class_findings(students: int) -> Iterator[Finding]:
    """Measures what a student costs this machine, and finds how many it carries and what many learners need."""
    from kit.school.capacity import RESERVE, Habits, class_capacity, server_need
    from kit.school.class_costs import AT_ONCE, NotMeasured, measure_costs, this_machine

    habits = Habits()
    try:
        machine, cost = this_machine(), measure_costs()
    except NotMeasured as error:
        messages.fail(f"--class: {error}.")
    section = "Measured here"
    yield Finding(
        section, "machine", f"{counted(machine.cores, 'core')}, {_gigabytes_text(machine.memory_bytes)} free"
    )
    yield Finding(
        section,
        "a drive",
        f"{cost.drive_cores:.2f} cores, {cost.drive_bytes / MEGA:.0f} MB",
        f"Mean of {AT_ONCE} at once that keys steer.",
    )
    yield Finding(
        section,
        "a check",
        f"{cost.check_core_s:.1f} s of a core, {cost.check_bytes / MEGA:.0f} MB",
        f"Of the solution of `grader new`; it took {cost.check_s:.1f} s.",
    )
    capacity = class_capacity(machine, cost, habits)
    fits = "carries them" if capacity.students >= students else "does not carry them all"
    section = f"A class of {students}"
    yield Finding(
        section,
        "this machine",
        fits,
        f"{counted(capacity.students, 'student')} at once; {capacity.scarce} would be short first "
        f"(cores for {capacity.by_cores}, memory for {capacity.by_memory}).",
    )
    yield Finding(
        section,
        "assumed",
        f"all drive, and check every {habits.seconds_between_checks:.0f} s",
        f"{RESERVE:.0%} of the machine stays free.",
    )
    section = "Before a deadline (simulated)"
    for learners in LEARNERS:
        need = server_need(learners, cost, habits)
        yield Finding(
            section,
            f"{learners:,} learners",
            f"{counted(need.check_cores, 'core')}, {_gigabytes_text(need.check_bytes)} for checks alone",
            f"{need.last_hour:,} hand-ins in the last hour; 95 of 100 wait at most {need.waits_s:.0f} s. With their drives on "
            f"the servers too, {need.most_at_work:,} at once: {need.drive_cores:,} cores and "
            f"{_gigabytes_text(need.drive_bytes)} more.",
        )
    yield Finding(
        section,
        "assumed",
        f"{habits.hand_ins} hand-ins each in {habits.days:.0f} days, on average {habits.mean_hours_left:.0f} h before the end",
        "An hour of driving before each; cores as here; a fixed seed.",
    )


def _gigabytes_text(size: float) -> str:
    return f"{size / GIGA:,.1f} GB"


def _check_workspace() -> Finding:
    folder = open_workspace(make=False).folder
    if not folder.exists():
        return Finding(
            "Your files", "workspace", str(folder), "Does not exist yet; the first start creates it."
        )
    if not folder.is_dir():
        return Finding(
            "Your files", "workspace", str(folder), "This is a file, not a folder: use --workspace FOLDER."
        )
    writable = os.access(folder, os.W_OK | os.X_OK)
    return Finding(
        "Your files", "workspace", str(folder), "Ready." if writable else "The kit cannot write to it."
    )


def findings() -> list[Finding]:
    """The whole report, in order. Asks the terminal, if there is one."""
    facts = TerminalFacts.here()
    # `kit doctor > file` asks about the terminal as `kit` would find it, not about the file.
    decision = decide_terminal(os.environ, replace(facts, stdout_tty=facts.stderr_tty))
    return [
        *_check_machine(),
        *_check_terminal(decision),
        *_check_packages(),
        *_check_extensions(),
        *_check_confinement(),
        _check_kernels(),
        _check_workspace(),
    ]


def as_text(report: list[Finding]) -> str:
    """The report in lines of at most 80 columns, but for a word that is longer itself."""
    sections: dict[str, list[tuple[str, str]]] = {}
    for finding in report:
        told = f"{finding.value}{' ' if finding.value.endswith('.') else ': '}{finding.meaning}"
        sections.setdefault(finding.section, []).append(
            (finding.name, told if finding.meaning else finding.value)
        )
    return "\n".join(lines_of([labelled_table(rows, title, indent=2) for title, rows in sections.items()]))


def as_json(report: list[Finding]) -> str:
    """The report as an object of sections, names, and ``value`` and ``meaning``."""
    sections: dict[str, dict[str, dict[str, str]]] = {}
    for finding in report:
        entry = {"value": finding.value, "meaning": finding.meaning}
        sections.setdefault(finding.section, {})[finding.name] = entry
    return json.dumps(sections, indent=2)


@click.command
@click.option(
    "--class",
    "students",
    type=click.IntRange(1, 100_000),
    metavar="N",
    help="Measure instead what students cost, and whether this machine carries N at once (half a minute).",
)
@click.option("--json", "machine_readable", is_flag=True, help="Print the report as JSON.")
def command(students: int | None, machine_readable: bool) -> None:
    """Report what the kit found on this machine and terminal, what it decided, and why.

    The running world and the packages are the subject of `kit ros doctor`.

    The output contains no secrets: paste it when you ask for help.
    """
    report = findings() if students is None else list(_class_findings(students))
    click.echo(as_json(report) if machine_readable else as_text(report))


@click.command()
def keys_command() -> None:
    """Show what this terminal sends for each key, and how you can drive with it. Ctrl-C leaves."""
    terminal = terminal_options.full_screen("The key test")

    def make_screen(app: KitApp) -> KeyTestScreen:
        from kit.tui.screens.key_test import KeyTestScreen

        return KeyTestScreen(terminal)

    show_screen(terminal, make_screen)
