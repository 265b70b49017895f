"""Runs ROS 2 programs that were written without knowledge of the kit, and judges each by what it does.

``python -m tests.ros.outside_programs`` prints a table of every set; ``--set second`` takes one of them, and numbers only
those programs. Each is ``NN_name.py`` with ``NN_name.yaml`` beside it, which says what its author means it to do.
"""

from __future__ import annotations

import argparse

from tests.ros.outside_programs.judge import SETS, programs_of, run_program


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("numbers", nargs="*", help="numbers of programs: 07 12")
    parser.add_argument("--set", choices=SETS, help="the folder of programs; without it, every one")
    parser.add_argument("--output", action="store_true", help="print what each program prints")
    chosen = parser.parse_args()
    programs = [
        each
        for name in ([chosen.set] if chosen.set else SETS)
        for each in programs_of(name)
        if not chosen.numbers or each.number in chosen.numbers
    ]
    working = 0
    for program in programs:
        outcome = run_program(program)
        working += not outcome.complaints
        if chosen.output:
            print(*(text for text, _ in outcome.lines), sep="\n")
        word = "does" if not outcome.complaints else "FAILS"
        print(f"{program.name:34}{word:6} {'; '.join(outcome.complaints)}", flush=True)
    print(f"{working} of {len(programs)} do what their author means")
    raise SystemExit(working < len(programs))


if __name__ == "__main__":
    main()
