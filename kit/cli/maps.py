"""``kit maps``: the maps that come with the kit."""

from __future__ import annotations

import shutil

import click

from kit.cli import options


@click.command()
@click.argument("name", required=False)
@options.glyphs
def command(name: str | None, glyphs: str | None) -> None:
    """List the maps, or show one as a picture with its starts and targets."""
    from kit.world.catalogue import UnknownMap, all_maps, find_map

    if name is None:
        cards = all_maps()
        width = max(len(card.name) for card in cards)
        for card in cards:
            click.echo(f"{card.name:{width}}  {card.summary}")
        click.echo("\n`kit maps NAME` shows one, `kit play NAME` opens it.")
        return
    try:
        card = find_map(name)
    except UnknownMap as error:
        options.fail(str(error))
    from kit.render.encode import ENCODERS
    from kit.render.world_text import scene_rows
    from kit.run.scenario import scenario_on_map
    from kit.run.session import Session
    from kit.run.view import ViewBuilder

    chosen = options.terminal(glyphs=glyphs).glyphs.value
    columns, rows = shutil.get_terminal_size()
    with Session(scenario_on_map(card)) as session:
        scene = ViewBuilder(session).build().scene
    click.echo(f"{card.title}: {card.summary}")
    click.echo("\n".join(scene_rows(scene, columns - 1, max(10, rows - 6), ENCODERS[chosen](True))))
    for case in card.cases:
        x, y, theta = case.start
        click.echo(
            f"{case.name}: from ({x:g}, {y:g}, {theta:g} rad) to within {case.target_radius:g} m of {case.target}"
        )
