"""Floor 4: connecting to a running world from another terminal of the same user.

The world has an ``InspectionServer``: a socket in the workspace, and a ``ClientConnection`` for each terminal that is
connected. The other end is an ``InspectionClient``: a graph of its own that mirrors the world's nodes, so that whatever
works on a graph (lists, subscriptions, service calls, publishers, whole programs) works from the second terminal too.
"""
