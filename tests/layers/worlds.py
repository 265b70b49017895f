"""Flatland worlds made by chance: every kind of body, every way of writing a list of layers."""

from __future__ import annotations

import random
from collections.abc import Sequence

MAP = "type: line_segments\ndata: lines.dat\nscale: 1\norigin: [0, 0, 0]\n"


def random_world(rng: random.Random) -> dict[str, str]:
    """The files of a sound world by name, ``world.yaml`` among them."""
    names = [f"n{i}" for i in range(rng.randint(1, 6))]
    files = {"map.yaml": MAP, "lines.dat": "0 0 1 0\n"}
    model_files = [f"m{i}.model.yaml" for i in range(rng.randint(1, 3))]
    for file in model_files:
        files[file] = _model(rng, names)
    models = [f"  - name: r{i}\n    model: {rng.choice(model_files)}\n" for i in range(rng.randint(1, 4))]
    files["world.yaml"] = f"# a world\nproperties: {{}}\n{_layers(rng, names)}models:\n{''.join(models)}"
    return files


def _layers(rng: random.Random, names: Sequence[str]) -> str:
    entries: list[list[str]] = []
    for name in names:
        if entries and rng.random() < 0.4:
            entries[-1].append(name)
        else:
            entries.append([name])
    lines = ["layers:"]
    for i, entry in enumerate(entries):
        has_map = i == 0 or rng.random() < 0.5
        written = entry[0] if len(entry) == 1 and rng.random() < 0.5 else f"[{', '.join(entry)}]"
        if rng.random() < 0.3:
            lines.append(f"  - {{name: {written}{', map: map.yaml' if has_map else ''}}}  # entry {i}")
        else:
            lines.append(f"  - name: {written}  # entry {i}")
            lines += ["    map: map.yaml"] * has_map
    return "\n".join(lines) + "\n"


def _model(rng: random.Random, names: Sequence[str]) -> str:
    bodies = [f"b{i}" for i in range(rng.randint(1, 3))]
    lines = ["bodies:"]
    for body in bodies:
        kind = rng.choice(["dynamic", "dynamic", "kinematic", "static"])
        lines += [f"  - name: {body}", f"    type: {kind}", "    footprints:"]
        for _ in range(rng.randint(1, 2)):
            lines += _footprint(rng, names)
    if len(bodies) > 1 and rng.random() < 0.5:
        joined = rng.choice(["true", "false"])
        ends = ", ".join(f"{{name: {body}, anchor: [0, 0]}}" for body in bodies[:2])
        lines += ["joints:", f"  - {{name: j, type: weld, bodies: [{ends}], collide_connected: {joined}}}"]
    if lasers := rng.randint(0, 2):
        lines.append("plugins:")
        for i in range(lasers):
            lines += [
                f"  - type: Laser  # number {i}",
                f"    name: eye{i}",
                f"    body: {rng.choice(bodies)}",
            ]
            lines += ["    range: 5", "    angle: {min: 0, max: 1, increment: 0.5}"]
            lines += _list(rng, names, "    ")
    return "\n".join(lines) + "\n"


def _footprint(rng: random.Random, names: Sequence[str]) -> list[str]:
    odd = rng.choice(["", "", "", "sensor: true", "collision: false"])
    shape = rng.choice(["radius: 0.2", "radius: 0.1"])
    center = rng.choice(["center: [0, 0]", "center: [0.5, 0]"])
    if rng.random() < 0.4:
        extra = "".join(f", {part}" for part in (odd, *_flow_list(rng, names)) if part)
        return [f"      - {{type: circle, {center}, {shape}, density: 1{extra}}}  # flow"]
    lines = ["      - type: circle  # block", f"        {center}", f"        {shape}", "        density: 1"]
    lines += [f"        {odd}"] if odd else []
    return [*lines, *_list(rng, names, "        ")]


def _chosen(rng: random.Random, names: Sequence[str]) -> list[str]:
    return rng.sample(list(names), rng.randint(0, len(names)))


def _flow_list(rng: random.Random, names: Sequence[str]) -> list[str]:
    style = rng.randrange(5)
    if style == 0:
        return []
    return ['layers: ["all"]' if style == 1 else f"layers: [{', '.join(_chosen(rng, names))}]"]


def _list(rng: random.Random, names: Sequence[str], indent: str) -> list[str]:
    """The lines of a ``layers`` key, in one of the ways people write them, or none."""
    chosen = _chosen(rng, names)
    if chosen and rng.random() < 0.4:
        return [f"{indent}layers:", *(f"{indent}  - {name}" + rng.choice(["", "  # why"]) for name in chosen)]
    return [indent + line for line in _flow_list(rng, names)]
