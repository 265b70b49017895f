"""pynput reads the keyboard of a desktop, and there is none here: its names, and a listener to the program's terminal.

Where the program has none, keys reach it all the same: the kit publishes what is pressed on ``/teleopkeys``.
"""

from pynput import keyboard

__all__ = ["keyboard"]
