"""The kind of submission ``function``."""
