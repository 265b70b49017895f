"""A docstring as blocks: its paragraphs, its examples, and the code that follows a double colon; tables are left out."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from typing import Final

from kit.document.blocks import Block, Code, Marked

_TABLE_RULE: Final = re.compile(r"=+ +=+")
_CODE_MARK: Final = "::"
_PROMPT: Final = ">>>"


def docstring_blocks(documentation: str) -> Iterator[Block]:
    """Yields the blocks of a docstring, in order.

    >>> [type(block).__name__ for block in docstring_blocks("Adds.\\n\\n>>> 1 + 1\\n2")]
    ['Marked', 'Code']
    """
    is_code = False
    for paragraph in re.split(r"\n\s*\n", inspect.cleandoc(documentation)):
        lines = paragraph.splitlines()
        if _TABLE_RULE.match(lines[0]):
            continue
        if lines[0].startswith(_PROMPT) or (is_code and lines[0].startswith(" ")):
            yield Code(tuple(inspect.cleandoc(paragraph).splitlines()))
            continue
        is_code = lines[-1].endswith(_CODE_MARK)
        text = "\n".join(line.strip() if line.startswith("- ") else line for line in lines)
        text = text.removesuffix(_CODE_MARK).rstrip() + (":" if is_code else "")
        yield Marked(text.replace("``", "`"))
