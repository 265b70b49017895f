"""Checks of controllers, by what they look at."""
