"""Keys: from the bytes a terminal sends to the commands a robot gets."""
