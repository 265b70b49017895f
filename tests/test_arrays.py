"""Arrays are called by the same names everywhere."""

from __future__ import annotations

import ast
from pathlib import Path

from kit import arrays

ROOT = Path(__file__).parents[1]


def test_no_other_module_spells_out_an_array_type_that_has_a_name() -> None:
    own = Path(arrays.__file__)
    module = ast.parse(own.read_text(encoding="utf-8"))
    named = {
        ast.unparse(each.value) for each in module.body if isinstance(each, ast.AnnAssign) and each.value
    }
    assert "NDArray[np.float64]" in named
    found = [
        f"{file.relative_to(ROOT)}:{each.lineno}"
        for room in ("kit", "grader", "tests")
        for file in sorted((ROOT / room).rglob("*.py"))
        if file != own and "NDArray[" in (text := file.read_text(encoding="utf-8"))
        for each in ast.walk(ast.parse(text))
        if isinstance(each, ast.Subscript) and ast.unparse(each) in named
    ]
    assert found == []
