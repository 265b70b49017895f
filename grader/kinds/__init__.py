"""Kinds of submissions: one folder each, found by its name; the record ``KIND`` of its ``kind.py`` tells how it is graded."""
