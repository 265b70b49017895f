"""The kind of submission ``training``."""
