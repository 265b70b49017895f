"""A private sshd on this machine, and a terminal with the kit in it on the other side of a slow link."""

from __future__ import annotations

import getpass
import os
import shlex
import shutil
import socket
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import kit as kit_package
from tests.tui.test_play_pty import User
from tests.waiting import wait_until

RELAY = Path(__file__).with_name("relay.py")
SSHD = shutil.which("sshd", path=f"{os.environ.get('PATH', '')}:/usr/sbin:/sbin")
SSH = shutil.which("ssh")
ROOT = Path(kit_package.__file__).parent.parent


@contextmanager
def private_sshd(folder: Path, begin: Sequence[str] = ()) -> Iterator[tuple[int, Path]]:
    """A server that keeps its keys in ``folder``: its port, and the key that opens it. OSError if it does not start.

    ``begin``: how the command begins that starts it, such as in another mount namespace."""
    for name in ("host", "user"):
        subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", folder / name], check=True)
    shutil.copy(folder / "user.pub", folder / "authorized_keys")
    with socket.create_server(("127.0.0.1", 0)) as found:
        port = found.getsockname()[1]
    (folder / "config").write_text(
        f"Port {port}\nListenAddress 127.0.0.1\nHostKey {folder}/host\nPidFile none\nUsePAM no\nStrictModes no\n"
        f"AuthorizedKeysFile {folder}/authorized_keys\nPasswordAuthentication no\nPermitRootLogin yes\n"
        "MaxStartups 100\n"
    )
    if os.geteuid() == 0:
        Path("/run/sshd").mkdir(exist_ok=True)
    assert SSHD
    command = [*begin, SSHD, "-D", "-e", "-f", folder / "config"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:

        def answers() -> bool:
            if process.poll() is not None:
                assert process.stderr
                raise OSError(f"sshd does not start here: {process.stderr.read()[-300:]}")
            try:
                socket.create_connection(("127.0.0.1", port), timeout=1).close()
            except OSError:
                return False
            return True

        try:
            wait_until(answers, "an answer of sshd", every_s=0.05)
            yield port, folder / "user"
        finally:
            process.terminate()


def open_kit(
    server: tuple[int, Path],
    workspace: Path,
    rate: float,
    delay: float,
    *arguments: str,
    account: str | None = None,
    installation: Path = ROOT,
    variables: Sequence[str] = (),
) -> User:
    """Runs ``kit`` with these arguments on the other side of a link of ``rate`` [bytes/s] and ``delay`` [s] each way.

    ``account``: whose terminal it is, by default this one's. ``installation``: the folder with the kit that runs.
    ``variables``: more of its environment, each as NAME=VALUE.
    """
    relay = shlex.join([sys.executable, str(RELAY), str(server[0]), str(rate), str(delay)])
    words = [
        f"KIT_WORKSPACE={workspace}",
        f"PYTHONPATH={installation}",
        *variables,
        sys.executable,
        "-m",
        "kit",
        *arguments,
    ]
    client = _client(server, account, "-tt", "-o", f"ProxyCommand={relay}")
    return User(str(Path(__file__).with_name("client.py")), *client, shlex.join(["env", *words]))


def run_over_ssh(
    server: tuple[int, Path], account: str, installation: Path, words: Sequence[str]
) -> subprocess.Popen[str]:
    """Starts Python with these arguments in an account's home."""
    remote = shlex.join(["env", f"PYTHONPATH={installation}", sys.executable, *words])
    return subprocess.Popen(
        [*_client(server, account, "-p", str(server[0])), remote],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def _client(server: tuple[int, Path], account: str | None, *flags: str) -> list[str]:
    options = {"StrictHostKeyChecking": "no", "UserKnownHostsFile": "/dev/null", "LogLevel": "ERROR"}
    given = [part for name, value in options.items() for part in ("-o", f"{name}={value}")]
    return [str(SSH), "-i", str(server[1]), *given, *flags, f"{account or getpass.getuser()}@127.0.0.1"]
