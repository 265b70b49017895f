"""Kinds of submissions: one module each, found by its name, whose record ``KIND`` tells how it is graded."""
