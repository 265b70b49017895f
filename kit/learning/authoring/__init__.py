"""What the author of a task uses: writes, checks, shows and packs task files."""
