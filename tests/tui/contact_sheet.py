"""Pictures of the kit's screens, to look at: each screen in each size, on dark and light, in each depth of colour.

    python tests/tui/contact_sheet.py --out sheets                         every screen, size, background and depth
    python tests/tui/contact_sheet.py --out sheets --screen drive --size 200x50 --color true --background dark

Each picture is the kit itself in a pseudo-terminal, read by pyte and drawn with Pillow; one sheet per screen puts them
side by side. Braille, blocks and lines are drawn by hand, so that they look the same with every font.
"""

from __future__ import annotations

import argparse
import fcntl
import os
import pty
import re
import select
import signal
import struct
import sys
import tempfile
import termios
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import pyte
from PIL import Image, ImageDraw, ImageFont

CELL_WIDTH, CELL_HEIGHT = 8, 16
FONTS: Final = (
    "DejaVuSansMono.ttf",
    "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf",
    "LiberationMono-Regular.ttf",
)
FAINT: Final = 0.6
"""How much of its colour faint text keeps."""
BACKGROUNDS: Final = {"dark": ((18, 18, 22), (208, 208, 208)), "light": ((252, 251, 247), (40, 40, 44))}
"""Background and foreground of the terminal."""
FOREGROUND_AND_BACKGROUND: Final = {"dark": "15;0", "light": "0;15"}
"""As a terminal tells them."""
ANSI: Final = {
    "black": (0, 0, 0),
    "red": (205, 49, 49),
    "green": (13, 150, 90),
    "brown": (190, 150, 20),
    "blue": (50, 110, 210),
    "magenta": (188, 63, 188),
    "cyan": (17, 150, 190),
    "white": (200, 200, 200),
    "brightblack": (110, 110, 110),
    "brightred": (241, 76, 76),
    "brightgreen": (35, 209, 139),
    "brightbrown": (230, 200, 60),
    "brightyellow": (230, 200, 60),
    "brightblue": (80, 150, 240),
    "brightmagenta": (214, 112, 214),
    "bfightmagenta": (214, 112, 214),  # pyte's own spelling
    "brightcyan": (41, 184, 219),
    "brightwhite": (240, 240, 240),
}


@dataclass(frozen=True, slots=True)
class ScreenVisit:
    """How a screen is reached."""

    arguments: tuple[str, ...] = ("start",)
    keys: tuple[str, ...] = ()
    """Sent one after another, each when the picture has come to rest or a second has passed."""
    seconds: float = 3.0
    """How long the screen runs before the picture is taken."""


OPENING: Final = (
    "opening ",
    "Opening ",
    "Getting ready",
    "Compiling for",
    "Reading your progress",
    "Running the drives again",
    "reading ...",
)
"""What a screen says while it is not yet what is to be seen."""
LONGEST_WAIT: Final = 60.0
"""For a world to be open [s]."""
BETWEEN_FRAMES: Final = 0.02
"""For so long nothing comes between two frames [s]."""
LONGEST_FRAME: Final = 3.0
"""After which a picture is taken all the same [s]."""
LESSONS: Final = Path(__file__).parents[2] / "lessons"
VISITS: Final = {
    "start": ScreenVisit(),
    "drive": ScreenVisit(("drive", "maze", "--controller", "random_walk"), (), 9.0),
    "robots-map": ScreenVisit(("drive", "maze", "--controller", "random_walk"), ("u", "2"), 6.0),
    "editor": ScreenVisit(("drive", "maze", "--controller", "random_walk"), ("\x05",), 4.0),
    "drive-hallway": ScreenVisit(("drive", "pair_turn", "--controller", "fields"), (), 5.0),
    "fields": ScreenVisit(("fields", "show", "pair_turn"), (), 4.0),
    "lessons": ScreenVisit(keys=("2",)),
    "lesson": ScreenVisit(("lesson", "1"), ("n",)),
    "read": ScreenVisit(("lesson", "A1"), ("l", "Robot learning\r")),
    "exercise": ScreenVisit(("lesson", "C1"), ("l", "circle\r")),
    "levels": ScreenVisit(("game",), seconds=6.0),
    "level": ScreenVisit(("game", "play", "first-drive"), tuple("www"), 6.0),
    "result": ScreenVisit(("game", "play", "first-drive"), tuple("zww...ssss"), 18.0),
    "daily": ScreenVisit(("game",), ("d",), 4.0),
    "leaderboard": ScreenVisit(("game",), ("f",), 3.0),
    "challenges": ScreenVisit(("game",), ("\x1b[D",), 3.0),
    "puzzle": ScreenVisit(("game",), ("\x1b[D", "\r", "\x1b[C" * 7 + "\x1b[B\x1b[A" * 6, "c"), 3.0),
    "puzzle-lasers": ScreenVisit(("game",), ("\x1b[D", *["\x1b[B"] * 8, "\r", "\x1b[C\x1b[C\x1b[B "), 3.0),
    "puzzle-layers": ScreenVisit(("game",), ("\x1b[D", *["\x1b[B"] * 3, "\r", "  \x1b[B "), 3.0),
    "nodes": ScreenVisit(("drive", "maze", "--controller", "random_walk"), ("n",), 4.0),
    "message-plot": ScreenVisit(("drive", "maze", "--controller", "random_walk"), ("n", "y", "\x1b[B"), 6.0),
    "layers": ScreenVisit(keys=("6", "m", "slides-lasers\r", "3")),
    "quiz": ScreenVisit(
        ("quiz", "2"),
    ),
    "form": ScreenVisit(("form",), ("3",)),
    "train": ScreenVisit(keys=("5",)),
    "new-training": ScreenVisit(keys=("5", "t"), seconds=5.0),
    "glossary": ScreenVisit(keys=(",",)),
    "palette": ScreenVisit(keys=("\x10",)),
    "progress": ScreenVisit(keys=("9",)),
    "league": ScreenVisit(keys=("l",), seconds=3.0),
    "help": ScreenVisit(("drive", "simple"), ("?",)),
    "keys": ScreenVisit(("keys",)),
    "map-drawing": ScreenVisit(("maps", "new", "hall"), ("\x1b[B" * 4 + "\x1b[C" * 9,)),
    "photo-corners": ScreenVisit(
        (
            "maps",
            "from-photo",
            f"{LESSONS}/35-photo-to-map/sheet/starter/plan.jpg",
            "sheet",
            "--width",
            "5",
            "--click",
        )
    ),
    "launch": ScreenVisit(
        ("launch", f"{LESSONS}/33-a-real-workspace/layout/starter/ros2_ws/src/scout_bringup"), (), 6.0
    ),
    "two-players": ScreenVisit(("game", "host", "two-doors", "--tag")),
    "replay": ScreenVisit(("game", "replay", "left-turn"), ("r",), 2.0),
}


class FaintScreen(pyte.Screen):
    """Keeps faint text, which pyte drops, as struck out: the kit strikes nothing out."""

    def select_graphic_rendition(self, *attrs: int, **kwargs: bool) -> None:
        told, waiting = [], list(reversed(attrs))
        while waiting:
            attr = waiting.pop()
            told.append(attr)
            if attr in (38, 48) and waiting:
                kind = waiting.pop()
                told += [kind, *(waiting.pop() for _ in range(min(len(waiting), 3 if kind == 2 else 1)))]
            elif attr in (2, 22):
                told.append(9 if attr == 2 else 29)
        super().select_graphic_rendition(*told, **kwargs)


def picture_of(
    visit: ScreenVisit, columns: int, rows: int, color: str, background: str, home: Path
) -> pyte.Screen:
    """The kit's screen after the visit's keys, as pyte holds it."""
    screen = FaintScreen(columns, rows)
    stream = pyte.ByteStream(screen)
    arguments = [sys.executable, "-m", "kit", *visit.arguments]
    pid, terminal = pty.fork()
    if pid == 0:
        environment = {
            **os.environ,
            "TERM": "xterm-256color",
            "HOME": str(home),
            "KIT_WORKSPACE": str(home / "robot-kit"),
            "KIT_COLOR": color,
            "COLORFGBG": FOREGROUND_AND_BACKGROUND[background],
        }
        for name in ("NO_COLOR", "KIT_THEME", "COLORTERM", "SSH_CONNECTION", "TMUX"):
            environment.pop(name, None)
        os.execve(sys.executable, arguments, environment)
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
    os.kill(pid, signal.SIGWINCH)
    try:
        _read(terminal, stream, 4.0, until_drawn=True)
        for key in visit.keys:
            _read_until_open(terminal, stream, screen, 1.5)
            os.write(terminal, key.encode())
        _read_until_open(terminal, stream, screen, visit.seconds)
    finally:
        os.write(terminal, b"\x03")
        time.sleep(0.3)
        os.kill(pid, signal.SIGKILL)
        os.waitpid(pid, 0)
        os.close(terminal)
    return screen


def _read_until_open(terminal: int, stream: pyte.ByteStream, screen: pyte.Screen, seconds: float) -> None:
    """Feeds the stream for that long, and on a busy machine until something is shown, nothing is being opened any more, and
    the last frame is whole."""
    end = time.monotonic() + LONGEST_WAIT
    _read(terminal, stream, seconds)
    while _is_opening(screen) and time.monotonic() < end:
        _read(terminal, stream, seconds)
    end = time.monotonic() + LONGEST_FRAME
    while select.select([terminal], [], [], BETWEEN_FRAMES)[0] and time.monotonic() < end:
        _read(terminal, stream, BETWEEN_FRAMES)


def _is_opening(screen: pyte.Screen) -> bool:
    """Whether nothing is shown yet, or that something is being opened."""
    lines = screen.display
    return not any(line.strip() for line in lines) or any(word in line for line in lines for word in OPENING)


def _read(terminal: int, stream: pyte.ByteStream, seconds: float, until_drawn: bool = False) -> None:
    """Feeds the stream for that long; answers what a terminal is asked. ``until_drawn``: the clock starts with the first byte."""
    end = time.monotonic() + (60.0 if until_drawn else seconds)
    while (left := end - time.monotonic()) > 0:
        if not select.select([terminal], [], [], left)[0]:
            continue
        try:
            data = os.read(terminal, 65536)
        except OSError:
            return
        if b"\x1b[6n" in data:
            os.write(terminal, b"\x1b[1;1R")
        if until_drawn and b"\x1b[" in data:
            end, until_drawn = time.monotonic() + seconds, False
        stream.feed(_without_keyboard_questions(data))


def _without_keyboard_questions(data: bytes) -> bytes:
    """Without what pyte would print: the kitty keyboard's requests."""
    return re.sub(rb"\x1b\[[<>=?][0-9;]*u", b"", data)


def draw(screen: pyte.Screen, background: str) -> Image.Image:
    """The screen as a picture of 8 x 16 pixels per character."""
    paper, ink = BACKGROUNDS[background]
    image = Image.new("RGB", (screen.columns * CELL_WIDTH, screen.lines * CELL_HEIGHT), paper)
    canvas = ImageDraw.Draw(image)
    font = _font()
    for y in range(screen.lines):
        for x in range(screen.columns):
            cell = screen.buffer[y][x]
            fg, bg = _rgb(cell.fg, ink), _rgb(cell.bg, paper)
            if cell.strikethrough:
                fg = tuple(round(FAINT * a + (1.0 - FAINT) * b) for a, b in zip(fg, bg, strict=True))
            if cell.reverse:
                fg, bg = bg, fg
            left, top = x * CELL_WIDTH, y * CELL_HEIGHT
            if bg != paper:
                canvas.rectangle((left, top, left + CELL_WIDTH - 1, top + CELL_HEIGHT - 1), fill=bg)
            for glyph in cell.data[:1]:
                _draw_glyph(canvas, glyph, left, top, fg, bg, font, cell.bold)
            if cell.underscore:
                canvas.line((left, top + 14, left + CELL_WIDTH - 1, top + 14), fill=fg)
    return image


def _draw_glyph(
    canvas: ImageDraw.ImageDraw,
    glyph: str,
    left: int,
    top: int,
    fg: tuple[int, int, int],
    bg: tuple[int, int, int],
    font: ImageFont.FreeTypeFont | ImageFont.ImageFont,
    bold: bool,
) -> None:
    code = ord(glyph)
    if glyph == " ":
        return
    if 0x2800 <= code < 0x2900:
        bits = (
            (0x01, 0, 0),
            (0x02, 0, 1),
            (0x04, 0, 2),
            (0x40, 0, 3),
            (0x08, 1, 0),
            (0x10, 1, 1),
            (0x20, 1, 2),
            (0x80, 1, 3),
        )
        for bit, x, y in bits:
            if code - 0x2800 & bit:
                canvas.rectangle(
                    (left + 1 + 4 * x, top + 1 + 4 * y, left + 2 + 4 * x, top + 2 + 4 * y), fill=fg
                )
        return
    block = _BLOCKS.get(glyph)
    if block is not None:
        for x0, y0, x1, y1 in block:
            canvas.rectangle(
                (left + x0 * 8 // 8, top + y0 * 2, left + x1 * 8 // 8 - 1, top + y1 * 2 - 1), fill=fg
            )
        return
    if glyph in "░▒▓":
        share = {"░": 0.25, "▒": 0.5, "▓": 0.75}[glyph]
        mixed = tuple(round(a * share + b * (1 - share)) for a, b in zip(fg, bg, strict=True))
        canvas.rectangle((left, top, left + 7, top + 15), fill=mixed)
        return
    lines = _LINES.get(glyph)
    if lines is not None:
        arms, width = lines
        ends = {"l": (0, 8), "r": (7, 8), "u": (4, 0), "d": (4, 15)}
        for arm in arms:
            canvas.line((left + 4, top + 8, left + ends[arm][0], top + ends[arm][1]), fill=fg, width=width)
        return
    canvas.text((left, top), glyph, fill=fg, font=font, stroke_width=0)
    if bold:
        canvas.text((left + 0.6, top), glyph, fill=fg, font=font)


_Q = {"ul": (0, 0, 4, 4), "ur": (4, 0, 8, 4), "ll": (0, 4, 4, 8), "lr": (4, 4, 8, 8)}
_BLOCKS: Final = {
    "█": [(0, 0, 8, 8)],
    "▀": [(0, 0, 8, 4)],
    "▄": [(0, 4, 8, 8)],
    "▌": [(0, 0, 4, 8)],
    "▐": [(4, 0, 8, 8)],
    "▘": [_Q["ul"]],
    "▝": [_Q["ur"]],
    "▖": [_Q["ll"]],
    "▗": [_Q["lr"]],
    "▚": [_Q["ul"], _Q["lr"]],
    "▞": [_Q["ur"], _Q["ll"]],
    "▛": [_Q["ul"], _Q["ur"], _Q["ll"]],
    "▜": [_Q["ul"], _Q["ur"], _Q["lr"]],
    "▙": [_Q["ul"], _Q["ll"], _Q["lr"]],
    "▟": [_Q["ur"], _Q["ll"], _Q["lr"]],
    **{chr(0x2580 + eighths): [(0, 8 - eighths, 8, 8)] for eighths in range(1, 8)},
    **{chr(0x2590 - eighths): [(0, 0, eighths, 8)] for eighths in range(1, 8)},
}
_LINES: Final = {
    **dict(
        zip(
            "─│┌┐└┘├┤┬┴┼╭╮╰╯",
            (
                (arms, 1)
                for arms in (
                    "lr",
                    "ud",
                    "rd",
                    "ld",
                    "ru",
                    "lu",
                    "udr",
                    "udl",
                    "lrd",
                    "lru",
                    "lrud",
                    "rd",
                    "ld",
                    "ru",
                    "lu",
                )
            ),
            strict=True,
        )
    ),
    **dict(
        zip(
            "━┃┏┓┗┛┣┫┳┻╋",
            ((arms, 3) for arms in ("lr", "ud", "rd", "ld", "ru", "lu", "udr", "udl", "lrd", "lru", "lrud")),
            strict=True,
        )
    ),
}


def _font() -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    for name in FONTS:
        try:
            return ImageFont.truetype(name, 13)
        except OSError:
            continue
    return ImageFont.load_default()


def _rgb(color: str, default: tuple[int, int, int]) -> tuple[int, int, int]:
    if color == "default":
        return default
    if color in ANSI:
        return ANSI[color]
    return int(color[:2], 16), int(color[2:4], 16), int(color[4:6], 16)


def sheet(pictures: list[tuple[str, Image.Image]], across: int) -> Image.Image:
    """The pictures in rows, each with its name above."""
    rows = [pictures[i : i + across] for i in range(0, len(pictures), across)]
    width = max(sum(image.width + 12 for _, image in row) for row in rows)
    height = sum(max(image.height for _, image in row) + 28 for row in rows)
    page = Image.new("RGB", (width, height), (90, 90, 96))
    canvas, font, top = ImageDraw.Draw(page), _font(), 0
    for row in rows:
        left = 6
        for name, image in row:
            canvas.text((left, top + 4), name, fill=(255, 255, 255), font=font)
            page.paste(image, (left, top + 22))
            left += image.width + 12
        top += max(image.height for _, image in row) + 28
    return page


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--out", type=Path, default=Path("sheets"))
    parser.add_argument("--screen", nargs="*", default=list(VISITS), choices=list(VISITS))
    parser.add_argument("--size", nargs="*", default=["80x24", "120x35", "200x50"])
    parser.add_argument("--background", nargs="*", default=list(BACKGROUNDS), choices=list(BACKGROUNDS))
    parser.add_argument("--color", nargs="*", default=["none", "16", "256", "true"])
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as home:
        for name in options.screen:
            pictures = []
            for size in options.size:
                columns, rows = (int(part) for part in size.split("x"))
                for color in options.color:
                    for background in options.background:
                        screen = picture_of(VISITS[name], columns, rows, color, background, Path(home))
                        pictures.append((f"{name} {size} {color} {background}", draw(screen, background)))
            across = max(1, len(options.background) * len(options.color))
            sheet(pictures, across).save(options.out / f"{name}.png")
            print(options.out / f"{name}.png", flush=True)


if __name__ == "__main__":
    main()
