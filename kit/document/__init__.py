"""What is told: blocks, the layout that places them, and their renderers."""
