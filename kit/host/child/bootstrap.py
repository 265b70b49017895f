"""Starts a student's process. Run by its path, not imported: see ``process.interpreter_command``."""

import os
import sys


def begin() -> int:
    """Imports the supervisor of the kit that this file is part of. Nothing beside the kit becomes importable."""
    here = os.path.abspath(__file__)
    sys.path.insert(0, here[: here.rindex("/kit/host/child/")])
    from kit.host.child import supervisor

    del sys.path[0]
    return supervisor.run()


if __name__ == "__main__":
    # Not sys.exit: it would run the student's destructors and exit handlers, and wait for threads.
    os._exit(begin())
