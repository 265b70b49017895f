"""Makes and finds the worlds for the tests of the simulation."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
import yaml

from kit.msg.geometry_msgs import Twist, Vector3
from kit.sim.simulation import Simulation, load_world
from kit.world.records import World

OURS = Path(__file__).parent / "worlds"
FLATLAND = Path(__file__).parents[3] / "shared" / "flatland_worlds" / "avidbots-flatland"

Mapped = Mapping[str, Any]


@dataclass(frozen=True)
class Workshop:
    """Makes worlds, in a folder of the test's own, and finds those that are there."""

    folder: Path

    def find(self, name: str) -> World:
        """A world of ours, or one of Flatland's own, which is not here everywhere."""
        if not name.startswith("flatland:"):
            return load_world(OURS / name)
        path = FLATLAND / name.removeprefix("flatland:")
        if not path.exists():
            pytest.skip(f"Flatland's own world is not here: {path.name}")
        return load_world(path, root=FLATLAND)

    def file(self, name: str, content: object) -> Path:
        """JSON is YAML."""
        path = self.folder / name
        path.write_text(json.dumps(content))
        return path

    def world(
        self,
        models: Mapped,
        layers: Mapping[str, Sequence[Sequence[float]]] | None = None,
        *,
        poses: Mapping[str, Sequence[float]] | None = None,
        namespaces: Mapping[str, str] | None = None,
        plugins: Sequence[Mapped] = (),
    ) -> World:
        """``models`` by name; ``layers``: wall segments by layer names (``"a b"`` is one layer with two names),
        none for a layer without a map.
        """
        described: dict[str, Any] = {"properties": {}, "layers": [], "models": [], "plugins": list(plugins)}
        for names, segments in (layers or {}).items():
            layer = names.split()[0]
            entry: dict[str, Any] = {"name": names.split()}
            if segments:
                lines = [" ".join(map(str, segment)) for segment in segments]
                (self.folder / f"{layer}.dat").write_text("\n".join(lines) + "\n")
                self.file(
                    f"{layer}.yaml",
                    {"type": "line_segments", "data": f"{layer}.dat", "scale": 1, "origin": [0, 0, 0]},
                )
                entry["map"] = f"{layer}.yaml"
            described["layers"].append(entry)
        for name, model in models.items():
            self.file(f"{name}.model.yaml", model)
            described["models"].append(
                {
                    "name": name,
                    "model": f"{name}.model.yaml",
                    "pose": list((poses or {}).get(name, (0, 0, 0))),
                    "namespace": (namespaces or {}).get(name, ""),
                }
            )
        return load_world(self.file("world.yaml", described))

    def serp(
        self, walls: Sequence[Sequence[float]] = (), *, pose: Sequence[float] = (0, 0, 0), **changes: Mapped
    ) -> World:
        """The dissertation's robot among walls that it touches and sees; ``changes`` by plugin name."""
        model = yaml.safe_load((OURS / "serp.model.yaml").read_text())
        for plugin in model["plugins"]:
            plugin |= changes.get(plugin["name"], {})
        return self.world({"serp": model}, {"solid lidar": walls}, poses={"serp": pose})

    def model(self, *footprints: Mapped, plugins: Sequence[Mapped] = (), **body: Any) -> dict[str, Any]:
        """A model of one body, ``base``."""
        return {
            "bodies": [{"name": "base", "footprints": list(footprints), **body}],
            "plugins": list(plugins),
        }

    def circle(self, radius: float, **more: Any) -> dict[str, Any]:
        return {"type": "circle", "radius": radius, "density": 1, **more}

    def rectangle(self, x0: float, x1: float, y0: float, y1: float, **more: Any) -> dict[str, Any]:
        points = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
        return {"type": "polygon", "density": 1, "points": points, **more}


def command(forward: float, turn: float = 0.0, sideways: float = 0.0) -> Twist:
    return Twist(linear=Vector3(x=float(forward), y=float(sideways)), angular=Vector3(z=float(turn)))


def last_messages(simulation: Simulation, steps: int) -> dict[str, Any]:
    """The last message on each topic, after so many steps."""
    return {out.topic: out.message for out in simulation.step(steps)}
