"""A real SLURM cluster of one node on this machine: munged, slurmctld and slurmd with a configuration and ports of their own."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import time
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Final

TOOLS: Final = ("munged", "slurmctld", "slurmd", "sbatch", "scontrol", "sinfo")
START_S: Final = 60.0
PARTITION: Final = "robots"
CONFIGURATION: Final = """\
ClusterName=kit
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
MpiDefault=none
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} RealMemory={memory} State=UNKNOWN
PartitionName={partition} Nodes=ALL Default=YES MaxTime=01:00:00 State=UP OverSubscribe=FORCE:4
"""


def why_impossible() -> str:
    """Says why no cluster can be started here; empty if one can."""
    if os.geteuid() != 0:
        return "a cluster of one node is started by root alone"
    missing = [tool for tool in TOOLS if _find(tool) is None]
    return f"SLURM is not installed here ({missing[0]})" if missing else ""


@contextmanager
def one_node_cluster(folder: Path) -> Iterator[Mapping[str, str]]:
    """Starts the cluster in a folder, and ends it with the context. Yields the environment in which SLURM's commands find it.

    Raises OSError, with what its log says, if it does not start.
    """
    for name in ("state", "spool"):
        (folder / name).mkdir()
    (folder / "munge.key").write_bytes(os.urandom(1024))
    (folder / "munge.key").chmod(0o400)
    ports = [_free_port() for _ in range(2)]
    (folder / "slurm.conf").write_text(
        CONFIGURATION.format(
            folder=folder,
            host=socket.gethostname(),
            controller_port=ports[0],
            node_port=ports[1],
            cores=max(2, os.cpu_count() or 2),
            memory=os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") >> 20,
            partition=PARTITION,
        )
    )
    environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf"), "PATH": _path()}
    munge = [f"--{name}-file={folder}/munge.{name}" for name in ("key", "pid", "log", "seed")]
    with ExitStack() as stack:
        for command in (
            ["munged", "--foreground", "--force", f"--socket={folder}/munge.socket", *munge],
            ["slurmctld", "-D", "-i", "-f", str(folder / "slurm.conf")],
            ["slurmd", "-D", "-f", str(folder / "slurm.conf"), "-N", socket.gethostname()],
        ):
            stack.enter_context(_running(command, environment, folder))
            if command[0] == "munged":
                _wait_until(lambda: (folder / "munge.socket").exists(), folder)
        _wait_until(lambda: "idle" in _says(["sinfo", "--noheader", "-o", "%T"], environment), folder)
        yield environment


@contextmanager
def _running(command: list[str], environment: Mapping[str, str], folder: Path) -> Iterator[None]:
    with (folder / f"{command[0]}.out").open("w") as output:
        process = subprocess.Popen(
            [str(_find(command[0])), *command[1:]], env=environment, stdout=output, stderr=output
        )
    try:
        yield
    finally:
        process.terminate()
        try:
            process.wait(15)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def _wait_until(is_ready: object, folder: Path) -> None:
    end = time.monotonic() + START_S
    while not is_ready():  # type: ignore[operator]
        if time.monotonic() > end:
            logs = (file.read_text(errors="replace")[-300:] for file in sorted(folder.glob("*.[ol]*")))
            raise OSError("SLURM does not start here: " + " | ".join(logs))
        time.sleep(0.1)


def _says(command: list[str], environment: Mapping[str, str]) -> str:
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=False).stdout


def _path() -> str:
    return f"{os.environ.get('PATH', '')}:/usr/sbin:/sbin"


def _find(tool: str) -> str | None:
    return shutil.which(tool, path=_path())


def _free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as found:
        return int(found.getsockname()[1])
