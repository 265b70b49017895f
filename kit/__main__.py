"""``python -m kit`` is ``kit``."""

from kit.program import run

if __name__ == "__main__":
    run()
