"""Damages files at random: in bytes, lines, words and structure. Seeded, so an input can be made again."""

from __future__ import annotations

import copy
import json
import random
from collections.abc import Callable
from typing import Any

import yaml

LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
DUMPER = getattr(yaml, "CSafeDumper", yaml.SafeDumper)

WORDS = [
    *(
        "",
        "~",
        "null",
        "no",
        "true",
        "all",
        "0",
        "-1",
        "1e-320",
        "1e309",
        ".nan",
        "-.inf",
        "99999999999999999999",
    ),
    *(
        "[]",
        "{}",
        "[[]]",
        "{a: b}",
        "*color",
        "*nobody",
        "&color x",
        "!!python/object:os.system",
        "!t x",
        "? x",
        "|",
    ),
    *(
        "$include robot.model.yaml",
        "$include more.yaml",
        "$[include] more.yaml",
        "$include ../secret",
        "$eval 1",
    ),
    *("env(HOME)", "env(X, 3)", "param(x)", "..", "/", "/dev/zero", "picture.png", "lines.dat", "world.yaml"),
    *(
        '"\\0"',
        '"\\e[2J"',
        "\u202e",
        "日本語",
        "\ud7ff",
        "x" * 5000,
        "'",
        '"',
        "- ",
        ": ",
        "#",
        "%",
        "---\n",
        "\t",
        "\r",
    ),
]
VALUES: list[Any] = [
    *(
        None,
        True,
        0,
        -1,
        1e-320,
        1e300,
        2**70,
        float("nan"),
        float("inf"),
        "",
        "all",
        "x" * 300,
        "walls",
        "base",
    ),
    *([], {}, [[]], [0] * 20, [[0, 0]] * 4, {"name": "base"}, ["all", "all"], [None], {"type": "circle"}),
]

Files = dict[str, bytes]
Damage = Callable[[random.Random, Files, str], bytes]


def damage_bytes(rng: random.Random, files: Files, name: str) -> bytes:
    """Bytes changed, cut out, put in, or written twice."""
    content = bytearray(files[name])
    for _ in range(rng.randint(1, 5)):
        at = rng.randrange(len(content) + 1)
        some = slice(at, at + rng.randint(0, 8))
        content[some] = rng.choice([rng.randbytes(rng.randint(0, 4)), b"", bytes(content[some]) * 2])
    return bytes(content)


def damage_lines(rng: random.Random, files: Files, name: str) -> bytes:
    """Lines left out, repeated, moved, indented, or taken from another file."""
    lines = files[name].splitlines(keepends=True)
    other = files[rng.choice(sorted(files))].splitlines(keepends=True)
    for _ in range(rng.randint(1, 4)):
        at = rng.randrange(len(lines) + 1)
        some = lines[at : at + rng.randint(1, 4)]
        lines[at : at + len(some)] = rng.choice(
            [
                [],
                some * 2,
                some[::-1],
                [b"  " + line for line in some],
                [line.lstrip() for line in some],
                other[:3],
            ]
        )
    return b"".join(lines)


def damage_words(rng: random.Random, files: Files, name: str) -> bytes:
    """A word, a number or a bracket replaced by one that makes trouble."""
    words = files[name].decode("latin-1").replace("[", " [ ").replace("]", " ] ").split(" ")
    for _ in range(rng.randint(1, 3)):
        words[rng.randrange(len(words))] = rng.choice(WORDS)
    return " ".join(words).encode()


def damage_structure(rng: random.Random, files: Files, name: str) -> bytes:
    """Still good YAML, but a key or a value somewhere in it is another one, gone, or there twice."""
    document = next(iter(yaml.load_all(files[name], Loader=LOADER)), None)
    change_structure(rng, document)
    if name.endswith(".json"):
        return json.dumps(document).encode()
    return yaml.dump(document, Dumper=DUMPER, sort_keys=False, allow_unicode=True).encode()


def damage_value(rng: random.Random, files: Files, name: str) -> bytes:
    """Still good YAML, but a number or a word in it is another one."""
    document = next(iter(yaml.load_all(files[name], Loader=LOADER)), None)
    document = nudge_json(rng, document)
    return yaml.dump(document, Dumper=DUMPER, sort_keys=False, allow_unicode=True).encode()


def change_structure(rng: random.Random, document: Any) -> None:
    """Changes one to three places of a document in place: a key or a value is another one, gone, or there twice."""
    for _ in range(rng.randint(1, 3)):
        places = list(containers(document))
        if not places:
            break
        location = rng.choice(places)
        key = rng.choice(list(location) if isinstance(location, dict) else range(len(location)))
        act = rng.randrange(4)
        if act == 0:
            location[key] = copy.deepcopy(rng.choice(VALUES))
        elif act == 1:
            del location[key]
        elif act == 2 and isinstance(location, dict):
            location[rng.choice(["name", "type", "layers", "nmae", 1, None, "x" * 300])] = location.pop(key)
        else:
            location[key] = [location[key]] * rng.randint(0, 20)


def containers(value: Any) -> list[Any]:
    """Every mapping and list in the value that is not empty."""
    children = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    inner = [found for child in children for found in containers(child)]
    return [value, *inner] if isinstance(value, dict | list) and value else inner


def damage_json(rng: random.Random, document: Any) -> Any:
    """Returns a copy of a JSON document in which one to three values are others, gone, or there more than once."""
    document = copy.deepcopy(document)
    change_structure(rng, document)
    return document


def nudge_json(rng: random.Random, document: Any) -> Any:
    """Returns a copy of a JSON document in which one value of the innermost is another one of the same kind.

    Such a document passes the checks of its form and reaches what reads its meaning."""
    document = copy.deepcopy(document)
    leaves = [
        (location, key)
        for location in containers(document)
        for key in (location if isinstance(location, dict) else range(len(location)))
        if not isinstance(location[key], dict | list)
    ]
    if not leaves:
        return document
    location, key = rng.choice(leaves)
    value = location[key]
    same = [inner[other] for inner, other in leaves if type(inner[other]) is type(value)]
    if isinstance(value, int | float) and not isinstance(value, bool):
        same += [value + 1, value - 1, -value, 0, 1, 2**31, 2**53, 2**63 - 1]
    location[key] = rng.choice(same)
    return document


def damage_files(rng: random.Random, files: Files, structured: tuple[str, ...] = (".yaml",)) -> Files:
    """Returns the files with one or two of them damaged, in one way each. ``structured``: endings of YAML and JSON."""
    files = dict(files)
    for _ in range(rng.randint(1, 2)):
        name = rng.choice(sorted(files))
        ways: list[Damage] = [damage_bytes, damage_lines, damage_words]
        if name.endswith(structured):
            ways += [damage_structure, damage_value] * 3
        way = rng.choice(ways)
        try:
            files[name] = way(rng, files, name)
        except (yaml.YAMLError, ValueError):  # already damaged too much to be changed as YAML
            files[name] = damage_bytes(rng, files, name)
    return files
