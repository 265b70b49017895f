"""How a node counts each goal, one file a kind: written into its program, which needs nothing of the kit's."""
