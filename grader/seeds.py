"""Seeds of an assignment: which a criterion is graded on, how they are read, and how well secret ones are kept."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from enum import Enum
from typing import Final

from kit.plain_text import quoted
from kit.world.yaml_section import Section

MAX_SEED: Final = 2**63 - 1
GUESSABLE_BELOW: Final = 2**32
"""Seeds below can all be tried out within hours by a program that compares what it sees with what they would give."""


class SeedSet(Enum):
    """Selects the seeds that a criterion is graded on."""

    PUBLIC = "public"
    SECRET = "secret"
    ALL = "all"


def read_seed(section: Section, default: int | None = None) -> int:
    """Reads the key ``seed``; notes a mistake in the section."""
    if default is None:
        return section.integer("seed", minimum=0, maximum=MAX_SEED)
    return section.integer("seed", default, minimum=0, maximum=MAX_SEED)


def read_seeds(section: Section, key: str, default: Sequence[int]) -> tuple[int, ...]:
    """Reads a list of different seeds; notes a mistake in the section, and returns the default then."""
    seeds = section.integers(key, default, minimum=0, maximum=MAX_SEED)
    if len(set(seeds)) < len(seeds):
        section.error(f"{quoted(key)} names a seed twice", key)
        return tuple(default)
    return seeds


def counterpart_seed(number: int) -> int:
    """Returns a public seed, 0 to 999,999, from which a counterpart of secret evidence is made."""
    return int.from_bytes(hashlib.sha256(f"counterpart {number}".encode()).digest()[:8], "big") % 10**6


def short_seeds_warning(secret_seeds: Iterable[int]) -> str:
    """Returns a warning about secret seeds that can be guessed; empty if there are none."""
    seeds = tuple(secret_seeds)
    short = sum(seed < GUESSABLE_BELOW for seed in seeds)
    if not short:
        return ""
    return (
        f"WARNING: secret.yaml: {short} of {len(seeds)} secret seeds are below {GUESSABLE_BELOW}. A program can find a "
        "short seed by trying all of them against what it sees, and predict the next grading. Make longer ones with: "
        "python3 -c 'import secrets; print(secrets.randbits(62))'"
    )
