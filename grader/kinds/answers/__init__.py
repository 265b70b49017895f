"""The kind of submission ``answers``."""
