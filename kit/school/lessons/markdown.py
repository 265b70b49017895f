"""Markdown of other authors' lessons, put into the kit's markup: links become their words and address, everything else its words.

``markdown_it`` comes with Textual.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from markdown_it import MarkdownIt
from markdown_it.token import Token

from kit.document.markup import BLOCK_INDENT, BULLET


def markdown_to_markup(text: str) -> str:
    """Returns the same text in the markup that ``parse_markup`` reads.

    >>> markdown_to_markup("# Walls\\n\\nA *laser* sees **walls**:\\n\\n1. near\\n2. far")
    '**Walls**\\n\\nA laser sees **walls**:\\n\\n- near\\n- far'
    """
    tokens = MarkdownIt("commonmark").parse(text)
    blocks: list[str] = []
    is_item, in_heading = False, False
    for token in tokens:
        if token.type == "list_item_open":
            is_item = True
        elif token.type in ("heading_open", "heading_close"):
            in_heading = token.type == "heading_open"
        elif token.type in ("fence", "code_block"):
            lines = token.content.rstrip("\n").splitlines()
            blocks.append("\n".join(BLOCK_INDENT + line for line in lines))
            is_item = False
        elif token.type == "inline":
            words = " ".join("".join(_inline(token.children or ())).split())
            if in_heading:
                words = f"**{words.replace('**', '')}**"
            if is_item and blocks and blocks[-1].rpartition("\n")[2].startswith(BULLET):
                blocks[-1] += f"\n{BULLET}{words}"
            else:
                blocks.append(f"{BULLET if is_item else ''}{words}")
            is_item = False
    return "\n\n".join(blocks)


def _inline(tokens: Sequence[Token]) -> Iterator[str]:
    address = ""
    for token in tokens:
        if token.type == "text":
            yield token.content.replace("`", "'")
        elif token.type == "code_inline":
            yield f"`{token.content}`"
        elif token.type in ("strong_open", "strong_close"):
            yield "**"
        elif token.type in ("softbreak", "hardbreak"):
            yield " "
        elif token.type == "link_open":
            address = str(token.attrGet("href") or "")
        elif token.type == "link_close":
            yield f" ({address})" if address else ""
        elif token.type == "image":
            yield token.content
