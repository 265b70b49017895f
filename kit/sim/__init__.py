"""Floor 2, motion: one world's physics and plugins. pymunk is known here and nowhere else."""
