"""Twelve accounts on one machine, each over a real SSH connection: they drive, check and train at once.

``pytest -s tests/ssh/test_class.py -m nightly`` prints from a key to the picture, and the memory of each account.
"""

from __future__ import annotations

import os
import pwd
import random
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path
from statistics import median, quantiles
from tempfile import mkdtemp

import pytest

from kit.school.class_costs import _memory
from tests.benchmarks.key_to_picture import PRESS, RELEASE, heading
from tests.other_accounts import open_installation, warm_installation, why_impossible, with_interpreter
from tests.ssh.connection import SSH, SSHD, open_kit, private_sshd, run_over_ssh
from tests.tui.test_play_pty import User
from tests.waiting import wait_until

ACCOUNTS = 12
PRESSES = 6
"""Of each."""
LINK = (1e6, 0.005)
"""A network of a building [bytes/s, s]."""
SEED = 12
LIMIT_S = 300.0
MEMORY = 400e6
"""What no account needs for a drive [bytes]."""


@pytest.mark.pty
@pytest.mark.long
@pytest.mark.nightly
@pytest.mark.timeout(3600)
def test_twelve_accounts_drive_check_and_train_at_once() -> None:
    problem = why_impossible() or _missing_tool()
    if problem:
        pytest.skip(problem)
    with ExitStack() as stack:
        installation = stack.enter_context(open_installation())
        warm_installation(installation)
        homes = stack.enter_context(accounts(ACCOUNTS))
        keys = Path(stack.enter_context(_public_folder()))
        try:
            server = stack.enter_context(private_sshd(keys, with_interpreter()))
        except OSError as error:
            pytest.skip(str(error))
        for file in ("authorized_keys", "user.pub"):
            (keys / file).chmod(0o644)
        users = {}
        for name, home in homes.items():
            users[name] = open_kit(
                server,
                home / "robot-kit",
                *LINK,
                *("drive", "simple", "--controller", "teleop"),
                account=name,
                installation=installation,
            )
            stack.callback(users[name].close)
        screens = list(users.values())
        _until_all(screens, lambda user: "exact" in user.text and bool(heading(user)))
        times = sorted(_reactions(screens))
        print(
            f"\n{ACCOUNTS} accounts, key to picture: median {1000 * median(times):.0f} ms, "
            f"95 of 100 within {1000 * quantiles(times, n=20)[-1]:.0f} ms"
        )
        memory = [_memory_of(name) for name in homes]
        print(f"memory of each: {min(memory) / 1e6:.0f} to {max(memory) / 1e6:.0f} MB")
        assert len(times) == ACCOUNTS * PRESSES
        assert 0 < max(memory) < MEMORY
        first, second, *_ = homes
        file = homes[first] / "robot-kit"
        looked = run_over_ssh(server, second, installation, ["-c", f"import os; os.listdir({str(file)!r})"])
        assert "PermissionError" in looked.communicate(timeout=LIMIT_S)[0]
        for title, words in (
            ("an example", ("-m", "grader", "new", "task")),
            ("a check", ("-m", "grader", "check", "task/solution.py", "--assignment", "task")),
            (
                "a training",
                ("-m", "kit", "train", "turn", "--name", "a", "--algo", "q-learning", "--steps", "2000"),
            ),
        ):
            began = time.perf_counter()
            _run_all([run_over_ssh(server, name, installation, words) for name in homes], screens)
            print(f"{title}, all at once while all drive: {time.perf_counter() - began:.0f} s")
        assert not [
            file for home in homes.values() for file in home.rglob("*.nbc")
        ]  # root has compiled for all


def _missing_tool() -> str:
    if not SSHD or not SSH:
        return "no sshd and ssh on this machine"
    missing = [tool for tool in ("useradd", "userdel") if shutil.which(tool) is None]
    return f"no {missing[0]} on this machine" if missing else ""


@contextmanager
def accounts(count: int) -> Iterator[dict[str, Path]]:
    """Makes accounts with a home each, by name; they and all that they have are removed afterwards."""
    made: dict[str, Path] = {}
    with _public_folder() as folder:
        try:
            for number in range(count):
                name, home = f"kittest{os.getpid() % 100_000}n{number}", Path(folder) / str(number)
                subprocess.run(
                    ["useradd", "-M", "-N", "-d", home, "-s", "/bin/sh", "-p", "*", name],
                    check=True,
                    capture_output=True,
                )
                made[name] = home
                home.mkdir(mode=0o755)
                os.chown(home, pwd.getpwnam(name).pw_uid, pwd.getpwnam(name).pw_gid)
            yield made
        finally:
            for name in made:
                wait_until(partial(_has_ended, name), f"the end of what {name} runs", every_s=0.1)
                subprocess.run(["userdel", name], check=True, capture_output=True)


def _has_ended(name: str) -> bool:
    """Kills what an account runs, and returns whether nothing was left."""
    left = _processes_of(name)
    for process in left:
        subprocess.run(["kill", "-9", process], check=False, capture_output=True)
    return not left


@contextmanager
def _public_folder() -> Iterator[str]:
    folder = mkdtemp(prefix="kit-class-")
    os.chmod(folder, 0o755)  # noqa: PTH101
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _processes_of(name: str) -> list[str]:
    user = pwd.getpwnam(name).pw_uid
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if process.stat().st_uid == user:
                found.append(process.name)
        except OSError:  # it has ended
            continue
    return found


def _memory_of(name: str) -> float:
    return sum(_memory(int(process)) for process in _processes_of(name))


def _until_all(users: Sequence[User], is_ready: Callable[[User], bool]) -> None:
    waiting = users
    end = time.monotonic() + LIMIT_S
    while waiting:
        assert time.monotonic() < end, waiting[0].text
        for user in users:
            user.pump(0.01)
        waiting = [user for user in waiting if not is_ready(user)]


def _reactions(users: Sequence[User]) -> list[float]:
    """Seconds from each press to the first picture with another heading, while all the others drive and are looked at."""
    chance = random.Random(SEED)
    times = []
    for _ in range(PRESSES):
        for user in chance.sample(users, len(users)):
            before, start = heading(user), time.perf_counter()
            user.send(PRESS)
            while heading(user) == before:
                for each in users:
                    each.pump(0.001)
                assert time.perf_counter() - start < LIMIT_S, user.text
            times.append(time.perf_counter() - start)
            user.send(RELEASE)
            until = time.perf_counter() + 0.2 + chance.random() / 10
            while time.perf_counter() < until:
                for each in users:
                    each.pump(0.001)
    return times


def _run_all(processes: Sequence[subprocess.Popen[str]], users: Sequence[User]) -> None:
    """Waits until all have ended well; the drives go on meanwhile."""
    end = time.monotonic() + 2 * LIMIT_S
    while any(process.poll() is None for process in processes):
        assert time.monotonic() < end
        for user in users:
            user.pump(0.01)
    for process in processes:
        said = process.communicate()[0]
        assert process.returncode == 0, said
        assert "Traceback" not in said
