"""Topics: one module each, found by its name, whose record ``TOPIC`` tells its page."""
