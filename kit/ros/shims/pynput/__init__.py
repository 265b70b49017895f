"""pynput reads the keyboard of a desktop, and there is none here: its names, and a listener that hears nothing.

Keys reach a package all the same: the kit publishes what is pressed on ``/teleopkeys``.
"""

from pynput import keyboard

__all__ = ["keyboard"]
