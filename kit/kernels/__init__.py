"""Floor 0: all jitted code, and the arrays that it takes."""
