"""Maps as arrays: their walls, floors, robots and obstacles, for compiled loops over many worlds."""
