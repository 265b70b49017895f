"""Confinement of student processes: limits, Landlock, seccomp, namespaces, and what this machine supports."""
