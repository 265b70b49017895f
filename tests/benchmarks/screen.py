"""What the world view costs: ``python tests/benchmarks/screen.py``.

A robot drives through a maze, seen at twenty frames a second; bytes and processor time are counted per frame
and given per second. Each is compared with the naive way: the whole picture sent with every frame, in true
colours, as a widget does that refreshes itself without saying where.
"""

from __future__ import annotations

import os
import sys
import time
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))
os.environ["TEXTUAL_COLOR_SYSTEM"] = (
    "truecolor"  # read when Textual is imported; our own colours are 16 all the same
)

import numpy as np
from textual.pilot import Pilot

from kit.arrays import FloatArray
from kit.render.camera import Camera
from kit.render.encode import ENCODERS, BrailleEncoder
from kit.render.painter import Painter
from kit.render.palettes import ANSI_PALETTE, COLOR_SCHEMES, Palette
from kit.render.roles import SHADES
from kit.render.scene import Scene
from tests.render.scenes import drive
from tests.tui.tape import ViewApp, painted, run_in

THEMED: Palette = COLOR_SCHEMES["dark"].palette(reduced=False)
NAIVE: Palette = {**THEMED, **{role: ANSI_PALETTE[role] for role in SHADES}}
"""True colours on the terminal's own background."""
FPS = 20
FRAMES = 300
SIZES = ((80, 24), (200, 50))
SEGMENTS = 5000


@dataclass(frozen=True)
class Cost:
    kilobytes: float
    """Per second."""
    core: float
    """Share of a processor core."""


def cost(
    size: tuple[int, int],
    glyphs: str = "braille",
    naive: bool = False,
    close: bool = False,
    palette: Palette = ANSI_PALETTE,
) -> Cost:
    """Of ``FRAMES`` frames, with Textual's share and all."""
    encoder = BrailleEncoder(layers=True) if palette is THEMED else ENCODERS[glyphs](False)
    app = ViewApp(encoder, palette, cropped=not naive)
    if naive or palette is THEMED:
        app.theme = "textual-dark"
    scenes = list(islice(drive(), FRAMES))
    if palette is THEMED:
        scenes = [replace(scene, beams=beams(scene)) for scene in scenes]
    sent: list[int] = []
    spent: list[float] = []

    async def script(pilot: Pilot[None]) -> None:
        app.view.show(scenes[0])
        if close:
            app.view.follow()
            app.view.zoom(3)
        await painted(app)
        app.terminal.take()
        for scene in scenes[1:]:
            start = time.process_time()
            app.view.show(scene)
            if naive:
                app.view.refresh()
            await painted(app)
            spent.append(time.process_time() - start)
            sent.append(len(app.terminal.take().encode()))

    run_in(app, script, size)
    return Cost(float(np.mean(sent)) * FPS / 1000, float(np.mean(spent)) * FPS)


def beams(scene: Scene) -> FloatArray:
    """The laser's rays, from the robot to what they hit."""
    return np.column_stack((np.full_like(scene.hits, scene.robots[0].pose[:2]), scene.hits))


def drawing(size: tuple[int, int], glyphs: str) -> tuple[float, float]:
    """Milliseconds to draw a scene of 5,000 wall segments: with the walls as they were, and with walls anew."""
    generator = np.random.default_rng(4)
    start = generator.uniform((0, 0), (8.25, 5.175), (SEGMENTS, 2))
    walls = np.concatenate((start, start + generator.normal(0, 0.05, start.shape)), axis=1)
    (seen,) = islice(drive(), 400, 401)
    scene = Scene(walls, seen.bodies, seen.hits, targets=seen.targets, trails=seen.trails)
    painter, camera = Painter(ENCODERS[glyphs](False)), Camera.fit(seen.bounds, *size)

    def per_frame(cameras: list[Camera]) -> float:
        painter.paint(scene, cameras[0])
        begin = time.perf_counter()
        for each in cameras:
            painter.paint(scene, each)
        return (time.perf_counter() - begin) / len(cameras) * 1000

    return per_frame([camera] * 200), per_frame([camera.panned(step % 2, 0) for step in range(1, 41)])


def main() -> None:
    for size in SIZES:
        name = f"{size[0]}x{size[1]}"
        naive = cost(size, naive=True, palette=NAIVE)
        print(
            f"{name}, naive, true colours: {naive.kilobytes:.1f} KB/s, {naive.core:.1%} of a core at {FPS} frames/s"
        )
        for glyphs in ENCODERS:
            ours = cost(size, glyphs)
            ratio = naive.kilobytes / ours.kilobytes
            print(
                f"{name}, {glyphs}: {ours.kilobytes:.1f} KB/s, {ours.core:.1%} of a core; naive / ours {ratio:.0f}"
            )
        close = cost(size, close=True)
        print(
            f"{name}, braille, close up and following: {close.kilobytes:.1f} KB/s, {close.core:.1%} of a core"
        )
        for close in (False, True):
            themed = cost(size, close=close, palette=THEMED)
            name_of_view = "close up and following" if close else "the whole map"
            print(
                f"{name}, true colours with a lit floor, {name_of_view}: {themed.kilobytes:.1f} KB/s,"
                f" {themed.core:.1%} of a core"
            )
        standing, anew = drawing(size, "braille")
        print(
            f"{name}, drawing with {SEGMENTS} segments: {standing:.2f} ms a frame, {anew:.2f} ms when it pans"
        )


if __name__ == "__main__":
    main()
