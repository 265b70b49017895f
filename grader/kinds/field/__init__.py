"""The kind of submission ``field``."""
