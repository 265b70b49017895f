"""The league: programs and agents that meet each other in races and at tag, and are rated by what came of it."""
