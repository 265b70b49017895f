"""The kind of submission ``drive``."""
