"""``kit maps``: the maps that come with the kit, and maps of one's own from a drawing or a photograph."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Collection, Iterable
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kit.cli import messages, options, terminal_options
from kit.cli.dialogue import run_dialogue
from kit.cli.existing_path import ExistingPath
from kit.cli.full_screen import run_screen
from kit.cli.lazy_group import NamesGroup, or_command
from kit.cli.process import ScreenClosed
from kit.document.blocks import Block, Picture, Table, Text, labelled_table
from kit.document.layout import lines_of
from kit.mapmaking.doubts import DOUBTS
from kit.mapmaking.doubts_dialogue import DoubtsDialogue, dotted_boxes
from kit.mapmaking.map_drawing import DrawingError, read_drawing
from kit.mapmaking.map_sketch import MapSketch
from kit.mapmaking.new_map import MapExists, check_name, tint_strokes, write_map
from kit.mapmaking.photo import PAPER, PhotoError, PhotoScale, open_photo, plan_from_photo, whole_picture
from kit.mapmaking.route import NoRoute
from kit.mapmaking.sketch_draft import SketchDraft
from kit.render.encode import ENCODERS
from kit.render.world_text import scene_rows
from kit.run.scenario import scenario_on_map
from kit.workspace import WorkspaceError, open_workspace
from kit.world.catalogue import (
    CARD_FILE,
    WORLD_FILE,
    MapCard,
    UnknownMap,
    all_maps,
    find_map,
    map_names,
    own_card,
    own_map_folder,
)
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from PIL.Image import Image

    from kit.mapmaking.new_map import NewMap, WallPlan
    from kit.mapmaking.photo import PhotoPlan
    from kit.mapmaking.pixels import Corners
    from kit.render.scene import ScenePath
    from kit.tui.app import KitApp
    from kit.tui.screens.dialogue import DialogueScreen
    from kit.tui.screens.map_drawing import MapDrawingScreen
    from kit.tui.screens.photo_corners import PhotoCornersScreen


@click.group(cls=NamesGroup, invoke_without_command=True)
@click.pass_context
def command(ctx: click.Context) -> None:
    """List the maps, show one, or make one of your own.

    \b
    kit maps                                list the kit's maps and your own
    kit maps maze                           draw one, with starts and targets
    kit maps new hall                       draw a map on the screen
    kit maps new hall --from hall.txt       read a drawing in characters
    kit maps new hall --pair                with two robots that drive as one
    kit maps from-photo plan.jpg --width 5  read a photograph of a drawing

    Your own maps are folders under worlds/ in your workspace. `kit drive`, `kit run` and `kit train` take the folder.
    """
    if ctx.invoked_subcommand is None:
        _list()


def _list() -> None:
    own = tuple(map(str, _own_maps()))
    listed: list[Block] = [Text("Your own:"), Picture(own, is_tight=True)] if own else []
    blocks: list[Block] = [
        maps_table(all_maps()),
        *listed,
        Text(
            "`kit maps NAME` shows one, `kit drive NAME` opens it, `kit maps --help` says how to make your own."
        ),
    ]
    click.echo("\n".join(lines_of(blocks)))


def maps_table(cards: Iterable[MapCard]) -> Table:
    """The maps there are: a name, and what there is to do."""
    return labelled_table((card.name, card.summary) for card in cards)


def _own_maps() -> list[Path]:
    try:
        folder = open_workspace(None, make=False).worlds
    except WorkspaceError:
        return []
    return sorted(card.parent for card in folder.glob(f"[!.]*/{CARD_FILE}"))


@command.command()
@click.argument("name", metavar="MAP or FOLDER")
@terminal_options.glyphs
def show(name: str, glyphs: str | None) -> None:
    """Draw a map with its starts and targets."""
    try:
        own = None if name in map_names() else _own_card_of(name, own_card, WORLD_FILE)
        _show_card(own or find_map(name), glyphs)
    except UnknownMap as error:
        messages.fail(or_command(str(error)))
    except WorldError as error:
        messages.fail(str(error))


command.taker = show


def _own_card_of(name: str, own_card: Any, world_file: str) -> MapCard | None:
    """The card of a folder, or of a map of that name in the workspace."""
    folders = [Path(name), *(each for each in _own_maps() if each.name == name)]
    return next(
        (card for each in folders if (card := own_card(each.absolute() / world_file)) is not None), None
    )


def _show_card(card: MapCard, glyphs: str | None, paths: tuple[ScenePath, ...] = ()) -> None:
    from kit.run.command_limits import describe_limits
    from kit.run.session import Session
    from kit.run.view import ViewBuilder

    chosen = terminal_options.decide(glyphs=glyphs).glyphs.value
    columns, rows = shutil.get_terminal_size()
    with Session(scenario_on_map(card)) as session:
        scene = ViewBuilder(session).build().scene
        limits = tuple(describe_limits(session.runner.simulation, session.scenario.partners))
    scene = replace(scene, paths=(*scene.paths, *paths))
    click.echo(f"{card.title}: {card.summary}")
    click.echo("\n".join(scene_rows(scene, columns - 1, max(10, rows - 6), ENCODERS[chosen](True))))
    for case in card.cases:
        x, y, theta = case.start
        messages.say(
            f"{case.name}: from ({x:g}, {y:g}, {theta:g} rad) to within {case.target_radius:g} m of "
            f"({case.target[0]:g}, {case.target[1]:g})"
        )
    for line in limits:
        messages.say(line)


@command.command()
@click.argument("name")
@click.option(
    "--from",
    "drawing",
    type=click.Path(dir_okay=False, allow_dash=True, path_type=Path),
    help="Text file with the drawing; - reads standard input (default: draw on the screen).",
)
@click.option(
    "--cell",
    type=click.FloatRange(0.02, 5.0),
    default=0.5,
    show_default=True,
    help="Side of the square that each character represents [m].",
)
@click.option(
    "--size",
    metavar="COLUMNSxROWS",
    default="26x20",
    show_default=True,
    help="Size of the drawing on the screen, in squares.",
)
@click.option("--pair", is_flag=True, help="Two robots start side by side and drive as one.")
@options.workspace
@terminal_options.glyphs
@terminal_options.color
def new(
    name: str,
    drawing: Path | None,
    cell: float,
    size: str,
    pair: bool,
    workspace: Path | None,
    glyphs: str | None,
    color: str | None,
) -> None:
    """Make a map. Draw it on the screen with the cursor or mouse, or read a text file.

    \b
    ############
    #S    #    #      # wall    blank or . floor
    #     #    #      S start of the robot
    #         T#      T target
    ############

    Without S or T, the kit chooses two places far apart. The robot must be able to drive from S to T.
    """
    try:
        folder = check_name(name, open_workspace(workspace).worlds)
        if drawing is None:
            _draw(folder, cell, size, glyphs, color, is_pair=pair)
            return
        text = sys.stdin.read() if str(drawing) == "-" else drawing.read_text(encoding="utf-8")
        plan = read_drawing(text, cell=cell, name="the drawing" if str(drawing) == "-" else str(drawing))
        made = write_map(folder, plan, title=_title(name), source="drawn in characters", is_pair=pair)
        scale = _drawing_scale(plan, cell)
    except UnicodeDecodeError:
        messages.fail(f"{drawing} is not text. To read a photograph, use `kit maps from-photo {drawing}`.")
    except OSError as error:
        messages.fail(messages.describe_os_error(error))
    except (MapExists, DrawingError, NoRoute, WorkspaceError) as error:
        messages.fail(str(error))
    _report(made, scale, glyphs)


def _title(name: str) -> str:
    return name.replace("_", " ").replace("-", " ").capitalize()


def _draw(
    folder: Path, cell: float, size: str, glyphs: str | None, color: str | None, *, is_pair: bool
) -> None:
    """Opens the sheet, and tells what was made of it. The drawing is kept beside the map, to be changed later."""
    terminal = terminal_options.full_screen(
        "Drawing on the screen",
        f"`kit maps new {folder.name} --from FILE` reads a drawing in characters: # wall, S start, T target.",
        glyphs=glyphs,
        color=color,
    )
    columns, _, rows = size.partition("x")
    try:
        sketch = MapSketch.room(int(columns), int(rows), cell)
    except ValueError as error:
        raise click.UsageError(f"--size takes two numbers, such as 40x20 ({error}).") from None

    draft = SketchDraft(folder)
    sketch, note = (sketch, "") if draft.found is None else (draft.found, "as you left it, not saved")

    scale = ""

    def save(drawn: MapSketch) -> NewMap:
        nonlocal scale
        plan = read_drawing(drawn.text, cell=drawn.cell)
        scale = _drawing_scale(plan, drawn.cell)
        made = write_map(
            folder, plan, title=_title(folder.name), source="drawn on the screen", is_pair=is_pair
        )
        (folder / "drawing.txt").write_text(drawn.text)
        return made

    def make_screen(app: KitApp) -> MapDrawingScreen:
        from kit.tui.screens.map_drawing import MapDrawingScreen

        return MapDrawingScreen(app.kit_theme, folder.name, sketch, save, note=note, keep=draft.keep)

    screen, code = run_screen(terminal, make_screen)
    keeps = screen.saved is None and not screen.is_given_up
    draft.close(keeps=keeps)
    if screen.saved is not None:
        _report(screen.saved, scale, glyphs)
    elif keeps and (note or screen.sketch != sketch):
        click.echo(f"The map is not saved yet. `kit maps new {folder.name}` shows your drawing again.")
    else:
        click.echo("Nothing was saved.")
    raise ScreenClosed(code)


@command.command(name="from-photo")
@click.argument("picture", type=ExistingPath(dir_okay=False, path_type=Path))
@click.argument("name", required=False)
@click.option("--width", type=click.FloatRange(0.5, 200.0), help="Width of the whole sheet in the world [m].")
@click.option(
    "--walls-width",
    type=click.FloatRange(0.3, 200.0),
    help="Instead of --width: distance between the outer sides of the leftmost and rightmost walls [m].",
)
@click.option(
    "--paper",
    type=click.Choice(["a4", "letter", "square"]),
    default="a4",
    show_default=True,
    help="Shape of the sheet.",
)
@click.option(
    "--corners",
    metavar="'X,Y X,Y X,Y X,Y'",
    help="Corners of the sheet in the photograph [pixels]: upper left, upper right, lower right, lower left "
    "(default: found automatically). 'whole': the picture is the sheet, as from a scanner.",
)
@click.option(
    "--click", "clicks", is_flag=True, help="Show the photograph, to click the corners of the sheet."
)
@click.option("--start", metavar="X,Y", help="Start of the robot [m from the sheet's lower left corner].")
@click.option("--target", metavar="X,Y", help="Target of the robot, likewise.")
@click.option(
    "--keep",
    "keep",
    type=click.Choice([*DOUBTS, "all", "none"]),
    multiple=True,
    help="Take this kind of doubtful lines for walls too, or all, or none; may be repeated (default: a terminal asks).",
)
@options.workspace
@terminal_options.glyphs
@terminal_options.color
def from_photo(
    picture: Path,
    name: str | None,
    width: float | None,
    walls_width: float | None,
    paper: str,
    corners: str | None,
    clicks: bool,
    start: str | None,
    target: str | None,
    keep: tuple[str, ...],
    workspace: Path | None,
    glyphs: str | None,
    color: str | None,
) -> None:
    """Make a map from a photograph of a drawing on paper.

    Draw the walls with a dark pen on white paper. Photograph the whole sheet on a darker table; tilt and shadows are
    fine. The kit finds the sheet, corrects the perspective, finds the lines, closes small gaps, removes specks, and
    checks that a robot can drive from start to target. Of lines that are much paler, thinner or smaller than the walls, or
    beyond them, such as the rules of the paper, folds and writing, it asks on a terminal whether they are walls; elsewhere
    they are left out and told, and --keep takes them too. Compare overlay.png in the map's folder with your drawing; if
    no map can be made, it is written here.

    \b
    kit maps from-photo plan.jpg --width 5             sheet 5 m wide
    kit maps from-photo plan.jpg hall --walls-width 4  outer walls 4 m apart
    kit maps from-photo plan.jpg --width 5 --click     click the corners
    """
    try:
        scale = PhotoScale(width, walls_width)
    except PhotoError as error:
        raise click.UsageError(str(error)) from None
    if clicks and corners is not None:
        raise click.UsageError("--click and --corners cannot be combined; give one of them.")
    places = [_point(text, option) for text, option in ((start, "--start"), (target, "--target"))]
    try:
        folder = check_name(name or picture.stem, open_workspace(workspace).worlds)
        photo = open_photo(picture)
        known = _clicked(photo, picture.name, glyphs, color) if clicks else _corners(corners, photo)
        found = plan_from_photo(photo, scale, paper=PAPER[paper], corners=known, are_rough=clicks)
        found = found.keeping(_kept_doubts(found, keep, glyphs, color))
        tinted = tint_strokes(found.sheet, found.plan.walls, found.strokes.doubtful)
        plan = replace(found.plan, start=places[0], target=places[1])
        made = write_map(
            folder,
            plan,
            title=folder.name.replace("_", " ").capitalize(),
            source=f"a photograph, {picture.name}",
            overlay=tinted,
        )
    except OSError as error:
        messages.fail(messages.describe_os_error(error))
    except NoRoute as error:
        shown = Path(f"{folder.name}-overlay.png")
        tinted.save(shown)
        _say_doubts(found)
        messages.fail(f"{error} {shown} shows in red what was read as walls.")
    except (MapExists, PhotoError, WorkspaceError) as error:
        messages.fail(str(error))
    width_m, height_m = plan.size
    boxes = (dotted_boxes(each, plan.walls.shape[0], plan.resolution) for each in found.strokes.doubts)
    _report(
        made,
        f"Scale: sheet {width_m:.3g} m by {height_m:.3g} m, outer walls {found.walls_width:.3g} m apart "
        f"(from {'--width' if width is not None else '--walls-width'}).",
        glyphs,
        tuple(chain.from_iterable(boxes)),
    )
    _say_doubts(found)


def _kept_doubts(
    found: PhotoPlan, keep: tuple[str, ...], glyphs: str | None, color: str | None
) -> Collection[str]:
    """The kinds of doubtful strokes to take for walls: those of ``--keep``; without it a terminal asks, and elsewhere none
    is taken."""
    if keep:
        return DOUBTS if "all" in keep else [each for each in keep if each != "none"]
    if not found.strokes.doubts or not (sys.stdin.isatty() and sys.stdout.isatty()):
        return ()

    terminal = terminal_options.decide(glyphs=glyphs, color=color)
    dialogue = DoubtsDialogue(found.strokes, ENCODERS[terminal.glyphs.value](True))
    code = 0
    if terminal.plain.value:
        run_dialogue(dialogue)
    else:

        def make_screen(app: KitApp) -> DialogueScreen:
            from kit.tui.screens.dialogue import DialogueScreen

            return DialogueScreen(dialogue)

        _, code = run_screen(terminal, make_screen)
    if not dialogue.is_over:
        click.echo("No map was made: you left before it was said what is a wall.")
        raise SystemExit(code or 1)
    return dialogue.kept


def _say_doubts(found: PhotoPlan) -> None:
    """Says what on the sheet may be no wall, and the option that takes it for one."""
    strokes = found.strokes
    if strokes.doubts:
        kinds = " ".join(f"--keep {each.kind}" for each in strokes.doubts)
        messages.say(
            f"In doubt: {'; '.join(strokes.remarks)}. What is dotted in the picture, and blue in overlay.png, was left out; "
            f"{kinds} takes it too."
        )
    elif strokes.notes:
        messages.say(f"In doubt: {'; '.join(strokes.notes)}. Compare overlay.png with your drawing.")


def _clicked(photo: Image, name: str, glyphs: str | None, color: str | None) -> Corners:
    """Shows the photograph until its sheet's corners have been put; ends without them if it is left before."""
    terminal = terminal_options.full_screen("--click", "--corners takes numbers.", glyphs=glyphs, color=color)

    def make_screen(app: KitApp) -> PhotoCornersScreen:
        from kit.tui.screens.photo_corners import PhotoCornersScreen

        return PhotoCornersScreen(app.kit_theme, name, photo)

    screen, code = run_screen(terminal, make_screen)
    if screen.found is None:
        click.echo("No map was made: the corners were not set.")
        raise SystemExit(code or 1)
    return screen.found


def _point(text: str | None, option: str) -> tuple[float, float] | None:
    if text is None:
        return None
    try:
        x, y = map(float, text.split(","))
    except ValueError:
        raise click.UsageError(
            f"{option} takes two numbers with a comma between them, such as {option} 1.5,2"
        ) from None
    return x, y


def _corners(text: str | None, photo: Image) -> Corners | None:
    if text is None:
        return None
    if text == "whole":
        return whole_picture(photo)
    found = [_point(each, "--corners") for each in text.split()]
    points = [each for each in found if each is not None]
    if len(points) != 4:
        raise click.UsageError(
            "--corners takes four points, such as '100,80 1500,95 1480,1100 90,1080'; or whole."
        )
    return points[0], points[1], points[2], points[3]


def _drawing_scale(plan: WallPlan, cell: float) -> str:
    width, height = plan.size
    return f"Scale: each character is a square of {cell:g} m; the drawing is {width:.3g} m by {height:.3g} m."


def _report(made: NewMap, scale: str, glyphs: str | None, doubtful: tuple[ScenePath, ...] = ()) -> None:
    """Draws a map that was made, and tells at which ``scale`` its drawing was read. ``doubtful``: boxes around what may be a
    wall and was left out."""
    card = own_card(made.folder / WORLD_FILE)
    assert card is not None  # just written
    _show_card(card, glyphs, doubtful)
    messages.say(scale)
    x, y = made.route.narrowest
    messages.say(
        f"The path from start to target is {made.route.length:.1f} m long; its narrowest passage, {made.route.width:.2f} m wide, "
        f"is at ({x:.2f}, {y:.2f})."
    )
    name = made.folder.name
    is_found = name not in map_names() and own_map_folder(name) == made.folder
    shown = name if is_found else made.folder
    click.echo(
        f"Written to {made.folder}\nDrive on it: kit drive {shown}\nTrain an agent on it: kit task new mine --from {shown}"
    )
