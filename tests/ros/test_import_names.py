"""ROS 2's import names are written from one table."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from kit.ros import NAMES_FOLDER
from tests.ros.import_names import name_files, read_table, write_files

HEADER = "module,name,source,kind\n"
OWN_TABLE = f"""{HEADER}shop.tools,Decimal,decimal:Decimal,
shop.tools,Fraction,fractions:Fraction,late
shop.tools,Number,numbers:Number,unlisted
shop.tools,Whole,numbers:Integral,unlisted
shop.tools,ini,configparser,late
shop.old.tools,*,shop.tools,
"""
PROGRAM = """
import sys
from shop import tools
assert not {"fractions", "configparser"} & set(sys.modules)
assert tools.__all__ == ["Decimal"], tools.__all__
assert (tools.Number.__name__, tools.Whole.__name__) == ("Number", "Integral")
from shop.old.tools import Fraction
assert Fraction is tools.Fraction is vars(tools)["Fraction"]
assert tools.ini is __import__("configparser")
try:
    tools.Rational
except AttributeError as error:
    print(error)
"""


def test_the_files_are_those_of_the_table() -> None:
    folder = Path(NAMES_FOLDER)
    written = {
        str(file.relative_to(folder)): file.read_text(encoding="utf-8") for file in folder.rglob("*.py")
    }
    assert written == name_files(), "run: python -m tests.ros.import_names"


def test_a_table_says_what_each_module_has_and_when_it_is_imported(tmp_path: Path) -> None:
    table = tmp_path / "table.csv"
    table.write_text(OWN_TABLE, encoding="utf-8")
    stale = tmp_path / "names" / "shop" / "gone.py"
    stale.parent.mkdir(parents=True)
    stale.touch()
    write_files(tmp_path / "names", table)
    assert not stale.exists()
    run = subprocess.run(
        [sys.executable, "-c", f"import sys; sys.path.insert(0, {str(tmp_path / 'names')!r})\n{PROGRAM}"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (run.stdout, run.stderr) == ("module 'shop.tools' has no attribute 'Rational'\n", "")


@pytest.mark.parametrize("rows", ["a,B,c:B,\na,B,d:B,late\n", "a,B,c:B,sometimes\n"])
def test_a_table_that_contradicts_itself_is_refused(tmp_path: Path, rows: str) -> None:
    file = tmp_path / "table.csv"
    file.write_text(HEADER + rows, encoding="utf-8")
    with pytest.raises(ValueError, match=r"a\.B"):
        read_table(file)
