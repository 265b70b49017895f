"""What a plan costs in time, and what the slides' method costs in layers: ``python tests/benchmarks/layers.py``.

One line per figure: the mean and the worst time of the cases of a kind, how many were proved optimal and how, and
how many layers more the slides' method takes on average (going down its list, and the best of 20 random orders).
"""

from __future__ import annotations

import random
import statistics
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from kit.layers.greedy import run_greedy
from kit.layers.planning import LayerPlan, solve_layers
from kit.layers.requirements import LayerCase
from tests.layers.cases import planted, random_case, random_graph


@dataclass(frozen=True)
class Kind:
    """Cases of one kind, and what is promised of them, if anything: seconds, of the mean or of each."""

    name: str
    make: Callable[[random.Random], LayerCase]
    count: int
    mean: float | None = None
    each: float | None = None
    time_limit: float = 10.0


KINDS = (
    Kind("10 entities, 3 lasers, density 0.2", lambda r: random_case(r, 10, 3, 0.2), 200, mean=0.01),
    Kind("10 entities, 3 lasers, density 0.5", lambda r: random_case(r, 10, 3, 0.5), 200, mean=0.01),
    Kind("20 entities, 6 lasers, density 0.3", lambda r: random_case(r, 20, 6, 0.3), 50),
    Kind("60 entities, 6 lasers, a world of 14 layers", lambda r: planted(r, 60, 6, 14, 20), 20, each=2),
    Kind("60 entities, 6 lasers, density 0.1", lambda r: random_case(r, 60, 6, 0.1, either=0.0), 10, each=2),
    Kind("60 entities, 6 lasers, density 0.2", lambda r: random_case(r, 60, 6, 0.2, either=0.0), 10, each=2),
    Kind(
        "60 entities, 6 lasers, density 0.3",
        lambda r: random_case(r, 60, 6, 0.3, either=0.0),
        5,
        time_limit=20,
    ),
    Kind("200 entities, density 0.1", lambda r: random_graph(r, 200, 0.1), 3, each=10),
    Kind("60 entities, density 0.5 (hard: an honest gap)", lambda r: random_graph(r, 60, 0.5), 2, each=11),
)


def proof(plan: LayerPlan) -> str:
    if not plan.is_optimal:
        return f"gap of {plan.gap} in {plan.size}"
    if plan.certificate.bound < plan.bound:
        return "search"
    return "weights" if plan.certificate.weighted_parts else "packing"


def measure(kind: Kind) -> bool:
    """Prints the line of one kind; whether it keeps what is promised."""
    rng = random.Random(1)
    plans = []
    behind: list[int] = []
    behind_at_best: list[int] = []
    for _ in range(kind.count):
        case = kind.make(rng)
        plan = solve_layers(case, time_limit=kind.time_limit)
        plans.append(plan)
        runs = [run_greedy(case)]
        if len(case.names) <= 60:
            runs += [run_greedy(case, choose=random.Random(seed).choice) for seed in range(20)]
        behind.append(runs[0].size + len(runs[0].missed) - plan.size)
        behind_at_best.append(min(run.size + len(run.missed) for run in runs) - plan.size)
    mean, worst = statistics.mean(p.seconds for p in plans), max(p.seconds for p in plans)
    kinds = sorted(proof(plan) for plan in plans)
    proofs = ", ".join(f"{kinds.count(kind)} {kind}" for kind in dict.fromkeys(kinds))
    kept = (kind.mean is None or mean <= kind.mean) and (kind.each is None or worst <= kind.each)
    print(
        f"{kind.name:<48} {1000 * mean:9.1f} ms mean {1000 * worst:9.1f} worst   "
        f"{statistics.mean(p.size for p in plans):7.1f} layers   {proofs:<36}"
        f"   slides' method +{statistics.mean(behind):.1f}, at its best +{statistics.mean(behind_at_best):.1f}"
        f"{'' if kept else '   TOO SLOW'}",
        flush=True,
    )
    return kept


if __name__ == "__main__":
    solve_layers(random_case(random.Random(0), 10, 3, 0.7))  # networkx and HiGHS are loaded once
    kept = [measure(kind) for kind in KINDS]
    sys.exit(0 if all(kept) else 1)
