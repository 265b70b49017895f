"""What can be handed in: one module a kind, found by its name, with one record ``KIND`` that says how it is graded."""
