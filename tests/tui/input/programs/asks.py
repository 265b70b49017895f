"""Asks the terminal about its keyboard and reports the answer."""

from __future__ import annotations

import dataclasses
import json
import os
import sys

from kit.tui.input.protocol import ask_keyboard

answer = ask_keyboard(0, 1, limit=float(sys.argv[1]))
report = dataclasses.asdict(answer) | {"releases": answer.releases}
os.write(int(os.environ["REPORT"]), json.dumps(report).encode() + b"\n")
