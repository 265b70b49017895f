"""What can go wrong when a launch is carried out."""


class CannotStart(Exception):
    """A process that cannot be started; the message says what is missing, and where it was asked for."""
