"""Floor 4: looking into a running world from another terminal of the same user.

A *door* belongs to the world: a socket in the workspace, and one *visitor* for each terminal that has come in. A
*visit* is the other end: a graph of its own with the world's nodes mirrored in it, so that whatever is written for
a graph (listing, listening, asking, publishing, whole programs) works from the second terminal too.
"""
