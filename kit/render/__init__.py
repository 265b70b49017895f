"""Drawing the world: a plain scene, a camera, and encoders that turn both into rows of characters or pixels.

Pure: it knows no terminal and no interface. A view of a running simulation is a ``Scene``; the screens and the
command line show the ``Frame`` that is drawn from it.
"""
