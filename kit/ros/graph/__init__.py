"""The graph of nodes: who is in it, which messages and callbacks are due, and its clock."""
