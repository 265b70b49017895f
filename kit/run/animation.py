"""Recorded runs as files to show around: asciicast, animated GIF and animated SVG."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal, NamedTuple

import numpy as np

from kit.render.animation_files import asciicast_lines, svg_animation
from kit.render.camera import Camera
from kit.render.encode import BrailleEncoder, Frame
from kit.render.image import IMAGE_THEMES, Pixels, draw_image, image_camera, save_animation
from kit.render.painter import Painter
from kit.render.palettes import ANSI_PALETTE, COLOR_SCHEMES
from kit.render.roles import Role
from kit.render.scene import Scene
from kit.run.episode import run_until
from kit.run.recording import Recording
from kit.run.scenario import Scenario
from kit.run.session import Session
from kit.run.view import ViewBuilder
from kit.workspace import check_writable, write_atomically

MAX_FRAMES: Final = 3000
"""Most frames of one file: five minutes at ten per second. A GIF of this size takes about 1 GB to make."""

DEFAULT_SIZES: Final = {".cast": (80, 24), ".gif": (640, 480), ".svg": (640, 480)}
"""Default size by extension: columns and rows, or the most pixels."""


class ExportError(Exception):
    """The recording cannot be written like this; the message says why, and what to do."""


class RecordedScene(NamedTuple):
    """What a recorded run looked like at a time [s] of the simulation."""

    time_s: float
    scene: Scene


@dataclass(frozen=True, slots=True)
class AnimationSettings:
    """How a recording is turned into a file."""

    speed: float = 1.0
    """Simulated seconds per second."""
    fps: float = 10.0
    """Frames per second."""
    size: tuple[int, int] | None = None
    """Columns and rows of an asciicast, pixels of a picture; None: ``DEFAULT_SIZES``. A picture is as high as the
    world's shape asks for, at most this high."""
    theme: Literal["light", "dark"] = "light"
    """On white or on black. A light asciicast uses the 16 colours of the terminal that plays it."""


def count_frames(recording: Recording, settings: AnimationSettings) -> int:
    """The number of frames that ``export_recording`` draws."""
    interval = _ticks_between(recording, settings)
    return recording.ticks // interval + 1 + (recording.ticks % interval > 0)


def recorded_scenes(
    recording: Recording,
    scenario: Scenario,
    interval: int,
    *,
    prepare: Callable[[Session], object] = lambda session: None,
) -> Iterator[RecordedScene]:
    """Runs a recording again and yields its start, the scene every ``interval`` ticks, and its end. ``prepare``: called with its
    session before it begins.

    Raises RecordingError where an input does not fit the world.
    """
    session = Session(scenario, seed=recording.seed, step_size=recording.step_size, always_scan=True)
    with session:
        prepare(session)
        session.play_back(recording)
        builder = ViewBuilder(session)
        yield RecordedScene(0.0, builder.build().scene)
        for tick in range(0, recording.ticks, interval):
            end = min(tick + interval, recording.ticks)
            run_until(session.runner, ticks=end - tick)
            yield RecordedScene(end * recording.step_size, builder.build().scene)


def export_recording(
    recording: Recording,
    scenario: Scenario,
    file: Path,
    settings: AnimationSettings = AnimationSettings(),
    *,
    title: str = "",
    on_frame: Callable[[], object] = lambda: None,
    prepare: Callable[[Session], object] = lambda session: None,
) -> None:
    """Writes a recording as ``.cast`` (asciicast, version 2), ``.gif`` or ``.svg``, as the file's ending says.

    ``scenario``: that of the recording, from ``find_scenario(recording.place, recording.case)``. ``on_frame`` is
    called after every frame, ``count_frames`` times; ``prepare`` with the session before it begins. The file is written
    whole or not at all.

    Raises ExportError for another ending or too long a run, RecordingError where an input does not fit the world,
    and OSError if the file cannot be written.

    >>> from kit.run.headless import run_episode
    >>> from kit.run.recording import load_recording
    >>> from kit.run.scenario import find_scenario
    >>> summary = run_episode("simple", "forward", seconds=1.0, record="run.npz")
    >>> export_recording(load_recording("run.npz"), find_scenario("simple"), Path("run.gif"))
    >>> Path("run.gif").read_bytes()[:6]
    b'GIF89a'
    """
    ending = file.suffix.lower()
    if ending not in DEFAULT_SIZES:
        raise ExportError(f"{file}: the name must end in {', '.join(DEFAULT_SIZES)}.")
    count = count_frames(recording, settings)
    if count > MAX_FRAMES:
        enough = count * settings.speed / MAX_FRAMES
        raise ExportError(
            f"The run takes {recording.ticks * recording.step_size:,.0f} s, which makes {count:,} frames; "
            f"{MAX_FRAMES:,} is the most. A speed of {np.ceil(enough):.0f} is enough, or fewer frames per second."
        )
    check_writable(file)
    columns, rows = settings.size or DEFAULT_SIZES[ending]

    def scenes() -> Iterator[RecordedScene]:
        for shown in recorded_scenes(
            recording, scenario, _ticks_between(recording, settings), prepare=prepare
        ):
            yield shown
            on_frame()

    name = title or scenario.title
    match ending:
        case ".cast":
            palette = COLOR_SCHEMES["dark"].palette(False) if settings.theme == "dark" else ANSI_PALETTE
            frames = (
                (shown.time_s / settings.speed, frame)
                for shown, frame in _text_frames(scenes(), columns, rows, name)
            )
            text = "\n".join(asciicast_lines(frames, palette, name)) + "\n"
            write_atomically(file, text.encode())
        case ".svg":
            interval_s = _ticks_between(recording, settings) * recording.step_size / settings.speed
            drawn = svg_animation(
                (shown.scene for shown in scenes()),
                interval_s,
                size=(columns, rows),
                title=name,
                theme=IMAGE_THEMES[settings.theme],
            )
            write_atomically(file, drawn.encode())
        case _:
            data = io.BytesIO()
            save_animation(data, _draw_pictures(scenes(), columns, rows, settings), settings.fps)
            write_atomically(file, data.getvalue())


def _ticks_between(recording: Recording, settings: AnimationSettings) -> int:
    return max(1, round(settings.speed / settings.fps / recording.step_size))


def _text_frames(
    scenes: Iterator[RecordedScene], columns: int, rows: int, title: str
) -> Iterator[tuple[RecordedScene, Frame]]:
    """Frames with a line of words above the picture: the title and the time."""
    painter, camera = Painter(BrailleEncoder()), None
    for shown in scenes:
        if camera is None:
            camera = Camera.fit(shown.scene.bounds, columns, rows - 1)
        picture = painter.paint(shown.scene, camera)
        frame = Frame.empty(columns, rows)
        frame.glyphs[1:], frame.fg[1:], frame.bg[1:] = picture.glyphs, picture.fg, picture.bg
        time_text = f"{shown.time_s:.1f} s"
        line = f"{title[: columns - len(time_text) - 1]:{columns - len(time_text)}}{time_text}"[:columns]
        frame.glyphs[0, : len(line)] = [ord(letter) for letter in line]
        frame.fg[0] = Role.TEXT
        yield shown, frame


def _draw_pictures(
    scenes: Iterator[RecordedScene], width: int, height: int, settings: AnimationSettings
) -> Iterator[Pixels]:
    camera = None
    for shown in scenes:
        if camera is None:
            bounds = shown.scene.bounds
            fitted = round(width * bounds.height / max(bounds.width, 1e-6))
            camera = image_camera(bounds, width, max(16, min(height, fitted)))
        yield draw_image(shown.scene, camera, IMAGE_THEMES[settings.theme])
