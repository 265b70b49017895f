"""The entries of a league: a folder with one program for each entrant, named after it.

An agent enters as the ROS 2 node that it would be on a robot, so a match runs programs alone, and is known by that program, not by
what anybody says of it. A file belongs to who has put it there; in a class's folder nobody can replace or remove another's. Whose
name and program is whose, the league's owner records with each run, so that who renews an entry keeps its name, and a clock that
was set back decides nothing.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path
from typing import Final

from kit.controllers import ControllerFile, controller_title, kit_controllers
from kit.learning.policies.policy_node_text import TITLE, learned_constants
from kit.plain_files import open_plain_file
from kit.plain_text import quoted, unknown_name
from kit.school.game.league.house import PROGRAM as HOUSE_PROGRAM
from kit.school.game.league.house import house_programs
from kit.school.game.player_progress import CODE_ERRORS, bare_code
from kit.school.game.race import DriverKind
from kit.school.game.shared_sockets import user_name
from kit.workspace import open_common_folder, write_atomically

FOLDER: Final = "entries"
MAX_BYTES: Final = {DriverKind.PROGRAM: 256 << 10, DriverKind.AGENT: 4 << 20}
"""Of an entry's file; an agent's network lies in it, and a program is read as code."""
MAX_ENTRIES: Final = 500
MAX_OF_ONE_USER: Final = 3
"""Entries of one user in another's league: more could drive against each other for one of them, and take the owner's time."""
MAX_LISTED_OF_ONE_USER: Final = 2 * MAX_OF_ONE_USER
"""Files of one user in another's league that are looked at, those that take no part included."""
MANIFEST: Final = "league.json"
HOLDERS: Final = "holders.json"
"""The user and the code of each name, as the league's owner has recorded them at the last run."""
MAX_HOLDERS_BYTES: Final = 1 << 20
NAME: Final = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,31}")


class LeagueError(Exception):
    """The league cannot do this; the message says why."""


@dataclass(frozen=True, slots=True)
class Entry:
    """One entrant."""

    name: str
    driver: DriverKind
    file: Path
    digest: str
    """Of the program; a match counts for exactly these programs."""
    code: str
    """Of its code alone: equal for programs that differ in comments and layout."""
    is_mine: bool
    user: int = -1
    """The number of the user whose file it is; -1 for one that cannot be read."""
    problem: str = ""
    """Why it takes part in no match; empty if it does."""
    house_program: bytes = b""
    """Its content, where it is one of the house, which has no file of its own; empty for everybody else."""

    @property
    def is_house(self) -> bool:
        """Whether it comes with the kit, and so wins no title."""
        return bool(self.house_program)

    def differs_from(self, program: bytes) -> bool:
        """Whether another program has other code, not only other comments or another layout."""
        return self.code != _driver_and_code(program)[1]

    @property
    def program(self) -> ControllerFile:
        return ControllerFile(self.name, self.file, controller_title(self.file))


def read_entries(folder: Path) -> tuple[Entry, ...]:
    """All entries of a league, by name. What is no entry's file is passed over. Raises LeagueError.

    Of two entries of one name or program, that takes part which the last run has recorded so, then that of the name's recorded
    holder, then the one that has been there for longer: whoever copies another's file into the folder, under whatever name, keeps nobody out, also when that is renewed.
    """
    holders, owner = _read_holders(folder), _owner_of(folder / MANIFEST)
    try:
        files = sorted((folder / FOLDER).iterdir(), key=lambda file: _rank(file, holders))
    except OSError:
        raise LeagueError(f"{folder}: there is no league; `kit league new {folder}` makes one.") from None
    shipped = _shipped_code()
    found: list[Entry] = []
    for file in files:
        name = file.name.removesuffix(".py")
        if not file.name.endswith(".py") or not NAME.fullmatch(name) or len(found) == MAX_ENTRIES:
            continue
        content, user, problem = b"", -1, ""
        try:
            with open_plain_file(file, follows_links=False) as opened:
                user = os.fstat(opened.fileno()).st_uid
                if user != owner and sum(each.user == user for each in found) >= MAX_LISTED_OF_ONE_USER:
                    continue
                content = opened.read(max(MAX_BYTES.values()) + 1)
        except OSError as error:
            problem = f"its file cannot be read ({error.strerror})"
        driver, code = _driver_and_code(content)
        digest = _digest(content)
        same = [each.name for each in found if each.code == code]
        others = sum(each.user == user and not each.problem for each in found)
        if not problem:
            if len(content) > MAX_BYTES[driver]:
                problem = f"its file is larger than {MAX_BYTES[driver] >> 10} KiB"
            elif code in shipped:
                problem = "this program comes with the kit"
            elif name.casefold() in [each.name.casefold() for each in found]:
                problem = "its name is taken"
            elif same:
                problem = f"it is the same program as {same[0]}"
            elif user != owner and others >= MAX_OF_ONE_USER:
                problem = f"its user has {MAX_OF_ONE_USER} other entries"
        found.append(Entry(name, driver, file, digest, code, user == os.getuid(), user, problem))
    return tuple(sorted(found, key=lambda each: each.name))


@cache
def house_entries() -> tuple[Entry, ...]:
    """The entries of the house, by speed. Nobody else's name can have a blank or brackets."""
    return tuple(
        Entry(f"{name} (house)", *_identity(program), is_mine=False, house_program=program)
        for name, program in house_programs().items()
    )


def _identity(program: bytes) -> tuple[DriverKind, Path, str, str]:
    driver, code = _driver_and_code(program)
    return driver, HOUSE_PROGRAM, _digest(program), code


def record_holders(folder: Path) -> None:
    """Records who holds which name: to be called by the league's owner before matches are driven. Raises LeagueError and OSError."""
    holders = {
        each.name.casefold(): [each.user, each.code] for each in read_entries(folder) if not each.problem
    }
    write_atomically(folder / HOLDERS, (json.dumps(holders, indent=1, sort_keys=True) + "\n").encode())


def _read_holders(folder: Path) -> dict[str, tuple[int, str]]:
    """Returns what ``record_holders`` has written; nothing for a file that is not the league's owner's, or holds something else."""
    try:
        with open_plain_file(folder / HOLDERS, follows_links=False) as opened:
            if os.fstat(opened.fileno()).st_uid != _owner_of(folder / MANIFEST):
                return {}
            found = json.loads(opened.read(MAX_HOLDERS_BYTES))
            return {name: (int(user), str(code)) for name, (user, code) in found.items()}
    except (OSError, ValueError, TypeError, AttributeError, RecursionError):
        return {}


def _owner_of(file: Path) -> int:
    """Returns the number of a file's user; -1 if there is no such file."""
    try:
        return file.lstat().st_uid
    except OSError:
        return -1


def _rank(file: Path, holders: Mapping[str, tuple[int, str]]) -> tuple[bool, bool, int, str]:
    """Returns by what entries are ordered: those first that are still what was recorded, then those of a name's holder, then by
    when a file was put there, by the system's clock, which its owner cannot set back as he can ``st_mtime`` [ns]."""
    try:
        status = file.lstat()
    except FileNotFoundError:  # withdrawn meanwhile
        return True, True, 0, file.name
    user, code = holders.get(file.stem.casefold(), (-1, ""))
    is_holder, is_same = user == status.st_uid, False
    if is_holder:
        with suppress(OSError), open_plain_file(file, follows_links=False) as opened:
            is_same = _driver_and_code(opened.read(max(MAX_BYTES.values()) + 1))[1] == code
    return not is_same, not is_holder, status.st_ctime_ns, file.name


def submit(folder: Path, name: str, program: bytes) -> Path:
    """Adds an entry, or renews one's own of that name. Returns its file. Raises LeagueError."""
    if not NAME.fullmatch(name):
        raise LeagueError(f"{quoted(name)} cannot be an entry's name: 1 to 32 letters, digits, - and _.")
    driver, code = _driver_and_code(program)
    if len(program) > MAX_BYTES[driver]:
        raise LeagueError(f"The program is larger than {MAX_BYTES[driver] >> 10} KiB.")
    for each in read_entries(folder):
        is_taken = not each.problem and each.name.casefold() == name.casefold()
        if is_taken and (each.name != name or not each.is_mine):
            whose = "You have" if each.is_mine else "Another user has"
            raise LeagueError(f"{whose} entered {each.name}: choose another name with --name.")
        if each.code == code and each.name != name:
            raise LeagueError(f"{each.name} is the same program.")
    if code in _shipped_code():
        raise LeagueError(
            "This program comes with the kit, and takes part in no league: copy it and make it yours."
        )
    file = folder / FOLDER / f"{name}.py"
    try:
        if problem := open_common_folder(file.parent):
            raise LeagueError(f"{file.parent}: {problem}.")
        write_atomically(file, program, follows_links=False)
    except OSError as error:
        raise LeagueError(f"{file} cannot be written ({error.strerror}).") from None
    return file


def renew_beside_former(folder: Path, name: str, program: bytes) -> str:
    """Renews one's entry of a name and keeps its former program as an entry of its own, a rival to beat. Returns the rival's name,
    the first of ``NAME-1``, ``NAME-2``, ... that is free. Raises LeagueError."""
    entries = read_entries(folder)
    former = find_entry(entries, name)
    taken = {each.name.casefold() for each in entries}
    names = (f"{name[:28]}-{number}" for number in range(1, MAX_ENTRIES + 2))
    rival = next(each for each in names if each.casefold() not in taken)
    try:
        content = former.file.read_bytes()
    except OSError as error:
        raise LeagueError(f"{former.file}: {error.strerror}.") from None
    submit(folder, name, program)
    submit(folder, rival, content)
    return rival


def withdraw(folder: Path, name: str) -> None:
    """Removes one's own entry; its matches count no more. Raises LeagueError."""
    entry = find_entry(read_entries(folder), name)
    try:
        entry.file.unlink()
    except PermissionError:
        if entry.is_mine:
            raise LeagueError(
                f"{entry.file} cannot be removed: its folder is not yours to write in."
            ) from None
        raise LeagueError(
            f"{quoted(name)} is an entry of {user_name(entry.user)}, who can withdraw it."
        ) from None
    except OSError as error:
        raise LeagueError(f"{entry.file} cannot be removed ({error.strerror}).") from None


def find_entry(entries: Sequence[Entry], name: str) -> Entry:
    """The entry of a name. Raises LeagueError."""
    for each in entries:
        if each.name == name:
            return each
    names = [each.name for each in entries]
    raise LeagueError(unknown_name("entry", name, names, "kit league"))


def program_of_agent(name: str, runs: Path) -> bytes:
    """The node of a training run, by name, or of a policy file. Raises LeagueError."""
    from kit.learning.policies.policy import PolicyError
    from kit.learning.policies.policy_file import load_policy
    from kit.learning.policies.policy_node import format_policy_node
    from kit.learning.training.run_config import RunError
    from kit.learning.training.run_folders import find_run

    try:
        file = Path(name)
        policy = load_policy(file) if file.is_file() else find_run(runs, name).policy()
        return format_policy_node(policy).encode()
    except (PolicyError, RunError, LookupError) as error:
        raise LeagueError(str(error)) from None


@lru_cache(MAX_ENTRIES)
def _driver_and_code(content: bytes) -> tuple[DriverKind, str]:
    """Who drives with a program: an agent where it is the kit's own node of one; and the digest of its code, of an agent's that of
    what it has learned, however it is called."""
    if len(content) > max(MAX_BYTES.values()):
        return DriverKind.PROGRAM, _digest(content)
    learned = learned_constants(content.decode(errors="replace"))
    if learned is not None:
        facts = sorted((name, value) for name, value in learned.items() if name != TITLE)
        return DriverKind.AGENT, _digest(repr(facts).encode())
    try:
        return DriverKind.PROGRAM, _digest(bare_code(content).encode())
    except CODE_ERRORS:
        return DriverKind.PROGRAM, _digest(content)


@cache
def _shipped_code() -> frozenset[str]:
    """Of the programs that come with the kit."""
    programs = [*(each.file.read_bytes() for each in kit_controllers()), *house_programs().values()]
    return frozenset(_driver_and_code(each)[1] for each in programs)


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
