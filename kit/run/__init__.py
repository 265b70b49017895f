"""Floor 4: running a world: the tick (runner.py), sessions, recordings, metrics, pacing."""
