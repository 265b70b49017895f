"""Floor 2, motion: one world's physics and devices. pymunk is known here and nowhere else."""
