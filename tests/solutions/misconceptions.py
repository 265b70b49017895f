"""Prints the misconceptions that the wrong works stand for: ``python -m tests.solutions.misconceptions``."""

from __future__ import annotations

from itertools import groupby

from kit.school.lessons.teachers_guide import Misconception, misconceptions

__all__ = ["Misconception", "misconceptions"]


def main() -> None:
    for (lesson, exercise), found in groupby(misconceptions(), key=lambda each: each[:2]):
        print(f"{lesson}/{exercise}")
        for each in found:
            print(f"    {'+'.join(each.criteria):<36} {each.why}")
            if each.sentence:
                print(f"    {'':<36} “{each.sentence}”")


if __name__ == "__main__":
    main()
