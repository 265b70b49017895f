"""Reads and runs submitted worlds in a process of their own, which reports plain records."""
