"""The first code of a student's process. Run by its path, not imported: see ``process.command``."""

import os
import sys


def begin() -> int:
    """Finds the kit, wherever this file lies, and goes on there. Nothing beside the kit becomes importable."""
    here = os.path.abspath(__file__)
    sys.path.insert(0, here[: here.rindex("/kit/host/child/")])
    from kit.host.child import supervisor

    del sys.path[0]
    return supervisor.run()


if __name__ == "__main__":
    # Not sys.exit: no student's thread, destructor or exit handler has a say any more.
    os._exit(begin())
