"""turtlesim: the paper that turtles draw on, the turtles, and the node that others talk to."""
