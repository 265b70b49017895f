"""A table in CSV, as learning platforms and spreadsheets write it: read whole, up to a limit, in whichever encoding.

Platforms write into it what students typed, such as a text handed in online: no such field may cost a class its grades.
"""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Final

from kit.plain_files import read_plain_file

MAX_BYTES: Final = 32 << 20


def read_csv_file(file: Path) -> list[list[str]]:
    """Returns the rows, the line of column titles first. Raises ValueError, with the file, and OSError."""
    data = read_plain_file(file, MAX_BYTES)
    try:
        text = data.decode("utf-16" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("cp1252", "replace")  # how a spreadsheet of Windows saves CSV by default
    separator = max(",;\t", key=text.partition("\n")[0].count)
    # The library's limit of a field is 128 KiB: less than a student may write. The file's size is the limit here.
    before = csv.field_size_limit(MAX_BYTES)
    try:
        return list(csv.reader(io.StringIO(text, newline=""), delimiter=separator))
    except csv.Error as error:
        raise ValueError(f"{file}: not a table in CSV: {error}") from None
    finally:
        csv.field_size_limit(before)
