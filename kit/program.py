"""Where the installed ``kit`` begins: not in ``__main__``, over which another package of the same name writes its own.

While the command line is imported, Ctrl-C ends the process as the system does it: Python's interrupt would end in a traceback
there, or be lost in a callback of the import's own.
"""

import signal

if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
    signal.signal(signal.SIGINT, signal.SIG_DFL)

from kit.cli import run

__all__ = ["run"]
