"""``kit completion``: what a shell needs to complete commands and options of ``kit`` and ``grader``."""

from __future__ import annotations

from typing import Final

import click
from click.shell_completion import get_completion_class

from kit.cli import messages

SHELLS: Final = ("bash", "zsh", "fish")
PROGRAMS: Final = ("kit", "grader")
PREPARATION: Final = {"zsh": "(( $+functions[compdef] )) || { autoload -Uz compinit && compinit }"}
"""What a script needs first: zsh loads its completion only where its settings say so, and a new account has none."""


@click.command()
@click.argument("shell", type=click.Choice(SHELLS))
@click.pass_context
def command(context: click.Context, shell: str) -> None:
    """Print a script that lets a shell complete commands and options with the Tab key.

    \b
    bash:  kit completion bash >> ~/.bashrc
    zsh:   kit completion zsh >> ~/.zshrc
    fish:  kit completion fish > ~/.config/fish/conf.d/kit.fish
    """
    completion = get_completion_class(shell)
    if completion is None:
        messages.fail(f"click has no completion for {shell}.")
    root = context.find_root().command
    if shell in PREPARATION:
        click.echo(PREPARATION[shell])
    for program in PROGRAMS:
        script = completion(root, {}, program, f"_{program.upper()}_COMPLETE")
        click.echo(script.source_template % script.source_vars())
