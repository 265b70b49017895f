"""What can be handed in: one module a kind, found by its name, with one record ``SORT`` that says how it is graded."""
