"""One scan as the simulator makes it, with scratch arrays of its own."""

from __future__ import annotations

from kit.kernels import kernels


def scan(
    pose: tuple[float, float, float],
    beams: kernels.Beams,
    max_range: float,
    walls: kernels.WallBlocks,
    shapes: kernels.Shapes,
    bits: int,
    ranges: kernels.Float32Array,
) -> None:
    """Fills ``ranges``; see ``kernels.scan_with``."""
    buffers = kernels.allocate_scan_buffers(beams.lines, kernels.most_corners(shapes.starts))
    kernels.scan_with(buffers, pose, beams, max_range, walls, shapes, bits, ranges)
