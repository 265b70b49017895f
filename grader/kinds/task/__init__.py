"""The kind of submission ``task``."""
