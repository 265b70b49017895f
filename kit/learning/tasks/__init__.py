"""Learning tasks as files: their records, their reader, their text."""
