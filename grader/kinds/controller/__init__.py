"""The kind of submission ``controller``."""
