"""Floor 1, what is: frozen records of a world, read from Flatland's YAML files. No physics, no messages."""
