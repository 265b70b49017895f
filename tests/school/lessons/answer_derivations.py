"""What a student finds who answers an exercise from its page: with the commands that it names, and from the figures that
the page and these commands show.

Each derivation returns, by question, everything that may be written down: a number as it is printed, as a calculator shows
it, and rounded like what it was computed from. No figure stands in a derivation: all are read from the page or from what
was printed.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from itertools import combinations
from pathlib import Path
from types import MappingProxyType
from typing import Final

from grader.assignment import Assignment
from grader.kinds.answers.kind import AnswerQuestion
from grader.reading import read_assignment
from kit.school.lessons.checking import install_exercise
from kit.school.lessons.records import Lesson, LessonStep
from kit.school.lessons.shell_lines import fill_in_paths
from tests.pasted_commands import LIMIT_S, Home, PastedCommand

FIGURE: Final = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?")
HOLD_UP: Final = b"\x1b[1;1:1A\x1b[1;1:3A"
"""The up arrow goes down and comes up."""
LEFT_DOWN: Final = b"\x1b[1;1:1D"
LEFT_UP: Final = b"\x1b[1;1:3D"

Answers = Mapping[str, tuple[str, ...]]
"""By question, all that a student may write who has found the answer."""


class ExercisePage:
    """An exercise as a student has it: the steps of the lesson up to it, its questions, its hints and its files."""

    def __init__(self, home: Home, lesson: Lesson, step: LessonStep) -> None:
        assert step.exercise is not None
        self._home = home
        self.step = step
        self.assignment: Assignment = read_assignment(step.exercise.folder)
        self.questions: Mapping[str, AnswerQuestion] = {
            each.name: each for each in self.assignment.task.questions
        }
        self.file = install_exercise(home.workspace, lesson, step.exercise)
        self._words = " ".join(" ".join(self._texts(lesson)).split())

    def _texts(self, lesson: Lesson) -> Iterator[str]:
        for each in lesson.steps[: self.step.number]:
            yield each.text
            yield from (command.line for command in each.commands)
        yield from (each.ask for each in self.questions.values())
        yield from (hint for criterion in self.assignment.criteria for hint in criterion.hints)
        yield self.file.read_text()

    def figures(self, name: str) -> list[float]:
        """The numbers in a question."""
        return figures(self.questions[name].ask)

    def run(self, line: str, like: str = "") -> str:
        """What a command prints. The page names it, or one that is ``like`` it with other values and no unnamed option."""
        with self._home.paste(self._named(line, like)) as pasted:
            pasted.until_end(LIMIT_S)
            return pasted.printed

    @contextmanager
    def open_world(self, line: str) -> Iterator[PastedCommand]:
        with self._home.open_world(self._named(line)) as world:
            yield world

    def ask(
        self, world: PastedCommand, line: str, answer: str = r"\S", like: str = "", keys: bytes = b""
    ) -> str:
        """What a command prints in a second terminal, once the pattern ``answer`` is found in it."""
        pattern = re.compile(answer, re.MULTILINE)
        return self._home.ask(self._named(line, like), world, lambda told: bool(pattern.search(told)), keys)

    def _named(self, line: str, like: str = "") -> str:
        """The command with the student's own paths."""
        assert (like or line) in self._words, f"the page does not name {like or line}"
        unnamed = [each for each in line.split() if each.startswith("--") and each not in self._words]
        assert unnamed == [], f"the page does not name {unnamed}"
        assert like.split()[:3] == line.split()[:3] or not like
        return fill_in_paths(line, self.file)


def figures(text: str) -> list[float]:
    """All numbers in a text."""
    return [float(each) for each in FIGURE.findall(text)]


def found(pattern: str, text: str) -> str:
    """What the one group of a pattern matches. It stands there once."""
    all_found = set(re.findall(pattern, text, re.MULTILINE))
    assert len(all_found) == 1, (pattern, all_found, text)
    return str(all_found.pop())


def exact(value: float) -> tuple[str, ...]:
    """A number that was computed from exact ones."""
    return (f"{value:.6g}",)


def rounded(value: float, decimals: int) -> tuple[str, ...]:
    """A number that was computed from rounded ones, as a calculator shows it, and with as many decimals as those."""
    return f"{value:.6g}", f"{value:.{decimals}f}"


# Looked up


def who(page: ExercisePage) -> Answers:
    printed = page.run("kit glossary episode")
    lesson = found(r"^episode +\((.+)\)$", printed)
    return {"looked_up": (lesson, lesson.split()[-1])}


def which_in_services(page: ExercisePage) -> Answers:
    with page.open_world("kit drive maze") as world:
        printed = page.ask(world, "kit ros param list", answer=r"^/random_walk:")
    names = found(r"^/random_walk:\n((?:  .*\n?)+)", printed).split()
    return {"count": exact(len(set(names) - {"use_sim_time"}))}


def what_happens(page: ExercisePage) -> Answers:
    """From the two last parts of what the kit says of the world."""
    printed = page.run("kit world check {folder}")
    _, _, parts = printed.partition("Who collides with whom\n")
    meetings, _, sights = parts.partition("Which laser sees whom\n")
    colliding = {
        frozenset(pair) for pair, relation in _relations(meetings).items() if relation == "collides with"
    }
    seen = [thing for (_, thing), relation in _relations(sights).items() if relation == "sees"]
    pairs = [name for name in page.questions if name != "laser_sees"]
    return {
        "laser_sees": (f"[{', '.join(seen)}]",),
        **{name: ("yes" if frozenset(name.split("_")) in colliding else "no",) for name in pairs},
    }


def _relations(table: str) -> dict[tuple[str, str], str]:
    """What is said of each pair in a part of ``kit world check``. Things by their first names."""
    told: dict[tuple[str, str], str] = {}
    subjects: list[str] = []
    for line in table.splitlines():
        if re.match(r"  \S", line):
            subjects = _things(line)
        elif row := re.match(r"    (\S+(?: \S+)*?)  +(.+?)(?:  +|$)", line):
            pairs = (
                combinations(subjects, 2)
                if row[2] == "one another"
                else ((subject, thing) for subject in subjects for thing in _things(row[2]))
            )
            told.update(dict.fromkeys(pairs, row[1]))
    return told


def _things(text: str) -> list[str]:
    return [re.split(r"[/ ]", each.strip())[0] for each in text.split(",")]


def layout(page: ExercisePage) -> Answers:
    """From two commands, and from the files of the workspace."""
    sources = page.file.parent / "ros2_ws" / "src"
    packages = page.run("kit pkg list --in {folder}/ros2_ws/src").split()
    programs = page.run("kit pkg executables --in {folder}/ros2_ws/src")
    needs = {
        each: set(
            re.findall(r"<exec_depend>(.+)</exec_depend>", (sources / each / "package.xml").read_text())
        )
        for each in packages
    }
    installed = (sources / "scout_bringup" / "setup.py").read_text()
    imported = re.findall(
        r"^(?:from|import) (\w+)", (sources / "scout_driver" / "scout_driver" / "drive.py").read_text(), re.M
    )
    return {
        "packages": (f"[{', '.join(packages)}]",),
        "program": (found(r"^scout_driver (\S+)", programs),),
        "left_out": _all_but(page.questions["left_out"].choices, lambda folder: f"{folder}/" in installed),
        "undeclared": _all_but(imported, lambda name: name in needs["scout_driver"]),
        "first": _all_but(packages, lambda package: bool(needs[package] & set(packages))),
        # What a terminal has sourced, no other terminal knows.
        "sourced": exact(
            len(re.findall(r"\b(?:one terminal|second|third)\b", page.questions["sourced"].ask, re.I))
        ),
    }


def _all_but(names: Iterable[str], is_out: Callable[[str], bool]) -> tuple[str, ...]:
    """The one of these names that is left."""
    left = tuple(name for name in names if not is_out(name))
    assert len(left) == 1, left
    return left


def evidence(page: ExercisePage) -> Answers:
    page.run("kit run maze --steps 2500 --seed 4 --bag walk")
    printed = page.run("kit ros bag info walk")
    rows = dict(re.findall(r"Topic: (\S+) \| Type: (\S+ \| Count: \d+)", printed))
    types = {name: each.split()[0] for name, each in rows.items()}
    counts = {name: int(each.split()[-1]) for name, each in rows.items()}
    seconds = float(found(r"^Duration: +([\d.]+)s$", printed))
    scans = [name for name, kind in types.items() if kind.endswith("/LaserScan")]
    return {
        "duration": rounded(seconds, 0),
        "scans": exact(sum(counts[name] for name in scans)),
        "tf_rate": rounded(counts["/tf"] / seconds, 0),
        "touch_type": (types["/collisions"],),
        "silent": (f"[{', '.join(name for name, count in counts.items() if not count)}]",),
        "keys": ("yes" if counts["/teleopkeys"] else "no",),
    }


# Measured


def readout(page: ExercisePage) -> Answers:
    topics = page.questions["pressed"].choices
    echo = "kit ros topic echo /teleopkeys"
    with page.open_world("kit drive simple --controller teleop") as world:
        assert re.search(r"^.*\bdistance +[\d.]+ m", world.user.text, re.M), "the row that a question names"
        heard = {
            topic: page.ask(world, echo.replace("/teleopkeys", topic), r"^---", like=echo, keys=HOLD_UP)
            for topic in topics
        }
        before = _heading(world)
        world.user.send(LEFT_DOWN)
        world.user.until(lambda: _heading(world) != before, "another heading")
        world.user.send(LEFT_UP)
        grown = _heading(world) - before
    speed, seconds = page.figures("way")
    ahead, turning = page.figures("radius")
    return {
        "pressed": _only(heard, "p_up"),
        "told": _only(heard, r"\Alinear:"),
        "back": _only(heard, "position:"),
        "heading": ("grows" if grown > 0 else "shrinks",),
        "way": exact(speed * seconds),
        "radius": exact(ahead / turning),
    }


def _heading(world: PastedCommand) -> int:
    """What stands on the panel [degrees]."""
    return int(found(r"\bheading +(-?\d+) °", world.user.text))


def _only(heard: Mapping[str, str], pattern: str) -> tuple[str, ...]:
    """The topic on which such a message comes."""
    return _all_but(heard, lambda topic: not re.search(pattern, heard[topic].strip()))


def live(page: ExercisePage) -> Answers:
    bandwidth = "kit ros topic bw /odom"
    with page.open_world("kit drive simple") as world:
        listeners = page.ask(world, "kit ros topic info -v /cmd_vel", r"^Subscription count: [1-9]")
        rates = page.ask(world, "kit ros topic hz /tf", "average rate")
        bytes_a_second = {
            topic: _bandwidth(page.ask(world, bandwidth.replace("/odom", topic), "/s from", like=bandwidth))
            for topic in page.questions["heavier"].choices
        }
        odom_type = page.ask(world, "kit ros topic type /odom")
        scans = page.ask(world, "kit ros topic find sensor_msgs/msg/LaserScan")
        move_type = page.ask(world, "kit ros service type /move_model")
        message = page.ask(world, "kit ros topic echo /odom --once", "frame_id")
    _, _, subscribers = listeners.partition("Subscription count:")
    return {
        "listener": (found(r"^Node name: (\S+)", subscribers),),
        "rate": tuple(
            each for rate in re.findall(r"average rate: ([\d.]+)", rates) for each in rounded(float(rate), 0)
        ),
        "odom_type": (odom_type.strip(),),
        "scans": (scans.strip(),),
        "heavier": (max(bytes_a_second, key=lambda topic: bytes_a_second[topic]),),
        "move_type": (move_type.strip(),),
        "frame": (found(r"^  frame_id: (\S+)", message),),
    }


def _bandwidth(printed: str) -> float:
    """The last one that was told [bytes/s]."""
    amount, unit = re.findall(r"([\d.]+) (B|KB|MB)/s from", printed)[-1]
    return float(amount) * {"B": 1.0, "KB": 1e3, "MB": 1e6}[unit]


def sheet(page: ExercisePage) -> Answers:
    """``smaller`` by the rule of the hint, and tried out with start and target named."""
    first = "kit maps from-photo {folder}/plan.jpg plan --width 5"
    printed = page.run(first)
    folder = Path(found(r"^Written to (.+)$", printed)).expanduser()
    passage = _passage(printed)
    (width,) = figures(first)
    (smaller,) = page.figures("smaller")
    needed = page.figures("least")[0]
    places = found(r"^plan: from \((.+), .+ rad\) to within", printed), found(r" of \((.+)\)$", printed)
    start, target = (
        ",".join(f"{float(each) * smaller / width:.3f}" for each in place.split(", ")) for place in places
    )
    tried = page.run(
        f"kit maps from-photo {{folder}}/plan.jpg small --width {smaller:g} --start {start} --target {target}",
        like=first,
    )
    return {
        "passage": (passage,),
        "way": (found(r"from start to target is ([\d.]+) m long", printed),),
        "pixel": (found(r"^resolution: ([\d.]+)", (folder / "map.yaml").read_text()),),
        "smaller": (*rounded(float(passage) * smaller / width, 2), _passage(tried)),
        "least": rounded(width * needed / float(passage), 2),
    }


def _passage(printed: str) -> str:
    """The narrowest place of the way [m], as the kit says it."""
    return found(r"narrowest\s+passage, ([\d.]+) m\s+wide", printed)


# Computed


def words(page: ExercisePage) -> Answers:
    *rewards, discount = page.figures("discounted")
    return {
        "sum": exact(sum(page.figures("sum"))),
        "discounted": exact(sum(reward * discount**steps for steps, reward in enumerate(rewards))),
    }


def by_hand(page: ExercisePage) -> Answers:
    text = " ".join(page.step.text.split())
    alpha, gamma, paid, others = (
        float(found(pattern, text))
        for pattern in (
            r"alpha is ([\d.]*\d)",
            r"gamma is ([\d.]*\d)",
            r"into G pays (\d+)",
            r"the others (\d+)",
        )
    )
    cells = found(r"the target: ((?:[A-Z] )+)G\.", text).split()

    def after(episodes: int) -> dict[str, float]:
        values = dict.fromkeys(cells, 0.0)
        for _ in range(episodes):
            for cell, following in zip(cells, [*cells[1:], None], strict=True):
                target = paid if following is None else others + gamma * values[following]
                values[cell] += alpha * (target - values[cell])
        return values

    episodes = {"one": after(1), "two": after(2), "many": after(1000)}
    value, reward, _ = page.figures("crash")
    return {
        "crash": exact(value + alpha * (reward - value)),
        **{
            name: exact(round(episodes[when][cell.upper()], 9))
            for name in page.questions
            if name != "crash"
            for cell, _, when in (name.partition("_"),)
        },
    }


def near_the_edge(page: ExercisePage) -> Answers:
    *values, cost, gamma = page.figures("q_target")
    moves = dict(zip(("ahead", "up", "back", "down"), values, strict=True))
    q_target = -cost + gamma * max(values)
    sarsa = {name: -cost + gamma * moves[name] for name in ("down", "ahead")}
    before, alpha = page.figures("q_value")
    (epsilon,) = page.figures("chance")
    (fall,) = page.figures("cost")
    chance = epsilon / len(moves)
    return {
        "q_target": exact(q_target),
        "sarsa_down": exact(sarsa["down"]),
        "sarsa_ahead": exact(sarsa["ahead"]),
        "q_value": exact(before + alpha * (q_target - before)),
        "sarsa_value": exact(before + alpha * (sarsa["down"] - before)),
        "chance": exact(chance),
        "cost": exact(chance * fall),
    }


def package(page: ExercisePage) -> Answers:
    rate, step_size = page.figures("factor")
    return {"factor": exact(rate * step_size)}


DERIVATIONS: Final[Mapping[str, Callable[[ExercisePage], Answers]]] = MappingProxyType(
    {
        "00-what-this-is-about/who": who,
        "01-drive/readout": readout,
        "03-services-and-parameters/which": which_in_services,
        "04-launch-files/package": package,
        "07-who-collides-who-sees/what-happens": what_happens,
        "10-words-of-learning/words": words,
        "20-q-learning/by_hand": by_hand,
        "21-sarsa-on-a-cliff/near_the_edge": near_the_edge,
        "32-command-line-and-bags/evidence": evidence,
        "32-command-line-and-bags/live": live,
        "33-a-real-workspace/layout": layout,
        "35-photo-to-map/sheet": sheet,
    }
)
"""By lesson and exercise. Each answers all questions but those of understanding."""
UNDERSTOOD: Final[Mapping[str, tuple[str, ...]]] = MappingProxyType(
    {
        "00-what-this-is-about/who": ("carries", "bump", "rule", "number", "measures", "strangers", "found"),
        "03-services-and-parameters/which": (
            "scans", "home", "wheels", "limit", "bump", "spawn", "topic_name",
        ),
        "04-launch-files/package": ("new_program", "not_found", "needs", "twice", "terminals"),
        "06-models-and-plugins/who-speaks": ("laser", "bumper", "diff_drive", "gps", "bool_sensor", "tween"),
        "10-words-of-learning/words": (
            "rule", "wheels", "nine", "everything", "left", "four", "whole", "crash", "arrived", "clock", "stuck",
        ),
        "21-sarsa-on-a-cliff/near_the_edge": ("explores", "simulator", "others"),
        "31-actions/which": ("kitchen", "battery", "reset", "arm", "speeds", "map", "dock"),
        "33-a-real-workspace/layout": ("build",),
    }
)  # fmt: skip
"""Questions of understanding, by lesson and exercise: nothing is looked up, measured or computed for them."""
