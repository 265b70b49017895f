"""How what a lesson says is found out again: each derivation lets the kit do it, and returns the words that are true."""

from __future__ import annotations

import math
import re
import shutil
from collections.abc import Callable, Mapping
from functools import cache
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from types import MappingProxyType
from typing import Final

import numpy as np
import yaml
from click.testing import CliRunner
from PIL import Image

from grader.evidence.contract import EvidenceOptions
from grader.evidence.training_results import TrainingResults
from grader.grading import GradingOptions, grade
from grader.kinds.training.kind import collect_evidence
from grader.reading import read_assignment
from grader.submission import read_submission
from kit.cli import main
from kit.controllers import find_controller
from kit.host.sandbox.sandbox_config import Level
from kit.layers.case_sources import open_task
from kit.layers.greedy import run_greedy
from kit.layers.planning import solve_layers
from kit.layers.requirements import LayerCase
from kit.learning.environment.env import TurnEnv
from kit.learning.policies.confidence_intervals import lower_bound
from kit.learning.tasks.catalogue import TURN
from kit.learning.tasks.rewards import ALGORITHM_3
from kit.msg.sensor_msgs import LaserScan
from kit.run.scenario import scenario_on_map
from kit.run.session import Session
from kit.school.lessons.reading import lessons_folder, solutions_folder
from kit.school.lessons.records import LessonStep
from kit.sim.simulation import Simulation, load_world
from kit.tui.input.drive_keys import named
from kit.world.catalogue import find_map
from kit.world.problems import WorldError
from kit.world.records import Polygon
from tests.school.lessons.capstone_derivations import CAPSTONE_DERIVATIONS
from tests.school.lessons.failure_derivations import FAILURE_DEAR, FAILURE_DERIVATIONS
from tests.school.lessons.follower_derivations import FOLLOWER_DERIVATIONS
from tests.school.lessons.generalisation_derivations import GENERALISATION_DERIVATIONS
from tests.school.lessons.imitation_derivations import IMITATION_DERIVATIONS
from tests.school.lessons.network_derivations import NETWORK_DERIVATIONS
from tests.school.lessons.own_task_derivations import OWN_TASK_DERIVATIONS
from tests.school.lessons.policy_derivations import POLICY_DERIVATIONS
from tests.school.lessons.table_derivations import TABLE_DERIVATIONS
from tests.sim.workshop import Workshop

Claim = Callable[[str, LessonStep, Path], str]
"""Gets the words, the step and an empty folder; returns the words as they must be."""

STEP_S: Final = 0.01
"""Duration of one step of the kit's worlds [s]."""
DECISION_S: Final = 0.1
"""Duration of one step of an environment [s]."""
NUMBER: Final = r"-?\d+(?:\.\d+)?"


def given(words: str, step: LessonStep, folder: Path) -> str:
    """A premise, a definition or a publication: no run decides it."""
    return words


def shell(*arguments: str) -> str:
    """The output of a command of the kit."""
    result = CliRunner().invoke(main, list(arguments))
    assert result.exit_code == 0, result.output
    return result.output


def exercise_folder(name: str) -> Path:
    return lessons_folder() / name


# Lessons 1 to 4: driving, nodes, services, launch files


def laser_rate(words: str, step: LessonStep, folder: Path) -> str:
    """Counts the scans of one simulated second."""
    sent = Simulation(Workshop(folder).serp([(5, -1, 5, 1)])).step(round(1 / STEP_S))
    return {10: "ten times a second"}[sum(isinstance(each.message, LaserScan) for each in sent)]


def teleop_near_walls(words: str, step: LessonStep, folder: Path) -> str:
    """Holds the up arrow until the robot touches a wall, and compares its speeds."""
    controller = find_controller("teleop")
    with Session(scenario_on_map(find_map("simple")), seed=1) as session:
        robot = session.scenario.robot
        assert robot is not None
        session.drive_with(controller)
        session.wait_until_driven()
        session.keys.publish(["p_up"])
        speeds, before = [], session.runner.simulation.pose(robot)
        while not session.metrics.metrics.bumps:
            session.runner.tick()
            now = session.runner.simulation.pose(robot)
            speeds.append(round(math.dist(now[:2], before[:2]) / STEP_S, 2))
            before = now
    fast, slow = max(speeds), speeds[-10]
    limit = re.search(rf'"wall_distance", ({NUMBER})', controller.file.read_text())
    assert limit is not None
    return f"within {limit[1]} m the robot goes { {0.5: 'half'}[slow / fast] } as fast"


def keystrokes(words: str, step: LessonStep, folder: Path) -> str:
    """What goes out for one key."""
    key = named("up")
    return f"{key.pressed} and {key.released}, pressed and released"


def stumbles_after(words: str, step: LessonStep, folder: Path) -> str:
    """When the scene's controller fails."""
    assert step.scene is not None
    told = CliRunner().invoke(
        main, ["run", "simple", "--controller", step.scene.controller, "--steps", "800"]
    )
    found = re.search(rf", ({NUMBER}) s of simulated time", told.output)
    assert found is not None, told.output
    return f"After { {3: 'three'}[round(float(found[1]))] } seconds it reaches that line"


def move_fields(words: str, step: LessonStep, folder: Path) -> str:
    answer = shell("ros", "interface", "show", "flatland_msgs/srv/MoveModel").partition("---")[2]
    return "here " + " and ".join(f"`{line.split()[1]}`" for line in answer.strip().splitlines())


def real_time(words: str, step: LessonStep, folder: Path) -> str:
    """Steps in a second of the wall clock times their length."""
    pairs = [(float(rate), float(size)) for rate, size in re.findall(r"(\d+) by (0\.\d+) s", words)]
    names = {1: "real time", 10: "ten times as fast"}
    first, second = (
        f"{rate:g} by {size:g} s is {names[round(rate * size)]}"
        if round(rate * size) == 1
        else f"{rate:g} by {size:g} s {names[round(rate * size)]}"
        for rate, size in pairs
    )
    return f"{first}, {second}"


def pause_holds(words: str, step: LessonStep, folder: Path) -> str:
    """The clock after a second of a paused world."""
    with Session(scenario_on_map(find_map("simple")), seed=1) as session:
        session.runner.paused = True
        session.runner.tick()
        before = session.runner.simulation.tick
        for _ in range(100):
            session.runner.tick()
        assert session.runner.simulation.tick == before
    return "The picture stands still in between"


def random_walk_set(words: str, step: LessonStep, folder: Path) -> str:
    """It reads its parameters while it is made, and nowhere else."""
    source = find_controller("random_walk").file.read_text()
    made = source.partition("def __init__")[2].partition("    def ")[0]
    assert made.count("declare_parameter") == source.count("declare_parameter") > 0
    assert "get_parameter(" not in source
    assert "add_on_set_parameters_callback" not in source
    return "`param set` changes nothing that you can see, although it says it did"


# Lessons 5 to 8: worlds, models, layers


def picture_edges(folder: Path, columns: int, resolution: float, left: float) -> tuple[float, float]:
    """Where a dark frame of so many columns begins and ends along x [m]."""
    pixels = np.full((20, columns), 255, dtype=np.uint8)
    pixels[[0, -1], :] = pixels[:, [0, -1]] = 0
    Image.fromarray(pixels).save(folder / "map.png")
    map_file = {"image": "map.png", "resolution": resolution, "origin": [left, 0, 0], "occupied_thresh": 0.65}
    (folder / "map.yaml").write_text(yaml.safe_dump(map_file))
    (folder / "world.yaml").write_text(
        yaml.safe_dump({"properties": {}, "layers": [{"name": "solid", "map": "map.yaml"}]})
    )
    walls = load_world(folder / "world.yaml").layers[0].walls
    assert walls is not None
    return float(walls.segments[:, ::2].min()), float(walls.segments[:, ::2].max())


def map_right_side(words: str, step: LessonStep, folder: Path) -> str:
    left, right = picture_edges(folder, 160, 0.05, -4)
    texts = (
        f"160 pixels times 0.05 m are {right - left:g} m; from {left:g} that leads to {right:g}",
        f"At x = {right:g}",
        f"160 x 0.05 = {right - left:g}",
        f"It is {right - left:g} m wide, right. But it begins at the origin, at x = {left:g}, and so ends at {right:g}.",
    )
    return next((each for each in texts if each == words), texts[0])


def map_divided(words: str, step: LessonStep, folder: Path) -> str:
    """The mistake's figure: pixels divided by the resolution."""
    return f"At x = {160 / 0.05:g}"


def picture_size(file: Path) -> tuple[int, int]:
    with Image.open(file) as picture:
        return picture.size


def starter_hall(words: str, step: LessonStep, folder: Path) -> str:
    maps = exercise_folder("05-world-files/to-scale") / "starter" / "maps"
    width, _ = picture_size(maps / "hall.png")
    return f"the hall comes out {width * yaml.safe_load((maps / 'hall.yaml').read_text())['resolution']:g} m wide"


def hall_pixels(words: str, step: LessonStep, folder: Path) -> str:
    size = picture_size(exercise_folder("05-world-files/to-scale") / "starter" / "maps" / "hall.png")
    return f"{size[0]} x {size[1]} pixels"


def thin_line(words: str, step: LessonStep, folder: Path) -> str:
    """A dark column of one pixel, in the middle of a bright picture: walls at two places along x."""
    pixels = np.full((20, 20), 255, dtype=np.uint8)
    pixels[:, 10] = 0
    picture_edges(folder, 20, 0.1, 0)
    Image.fromarray(pixels).save(folder / "map.png")
    walls = load_world(folder / "world.yaml").layers[0].walls
    assert walls is not None
    upright = {x for x, _, other, _ in walls.segments.tolist() if x == other}
    return f"a line that is one pixel wide makes { {2: 'two'}[len(upright)] } walls"


def pen_wall(words: str, step: LessonStep, folder: Path) -> str:
    """The inner wall of the reference solution."""
    solution = solutions_folder() / "05-world-files" / "drawn-with-lines" / "solution"
    scale = yaml.safe_load((solution / "pen.yaml").read_text())["scale"]
    rows = [line.split("#")[0].split() for line in (solution / "pen.dat").read_text().splitlines()]
    inner = [[float(each) * scale for each in row] for row in rows if row and row[0] == row[2] == "200"]
    return f"{abs(inner[0][3] - inner[0][1]):g} m long"


def all_mistakes(words: str, step: LessonStep, folder: Path) -> str:
    """A world with two mistakes in one file: the message names both, with lines and columns."""
    (folder / "world.yaml").write_text("properties: {}\nlayers: 3\nmodels: 4\n")
    try:
        load_world(folder / "world.yaml")
    except WorldError as error:
        places = re.findall(r"world\.yaml:(\d+):(\d+)", str(error))
        assert {line for line, _ in places} == {"2", "3"}
    else:
        raise AssertionError("the world was read")
    return words


PLUGINS: Final = (
    {
        "type": "Laser",
        "name": "laser",
        "body": "base",
        "range": 3,
        "angle": {"min": 0, "max": 1, "increment": 0.1},
        "update_rate": 20,
    },
    {"type": "Bumper", "name": "bumper"},
    {"type": "DiffDrive", "name": "drive", "body": "base"},
)
"""Without a ``topic``: so they have the usual ones."""


def plugin_topics(words: str, step: LessonStep, folder: Path) -> str:
    """Each topic in the words, and its type, is one that a robot with these plugins has, in that direction."""
    shop = Workshop(folder)
    body = {"name": "base", "footprints": [shop.circle(0.1)]}
    world = shop.world({"robot": {"bodies": [body], "plugins": PLUGINS}}, {"solid": [(1, -1, 1, 1)]})
    ends = Simulation(world).model_endpoints("robot")
    found = {(f"{end.direction}", end.topic[1:], end.type.__name__) for end in ends}
    for verb, topic, kind in re.findall(r"(publish|subscribe)e?s (?:to )?`([^`]+)`, an? (\w+)", words):
        assert (verb, topic, kind) in found
    return words


def polygon_corners(words: str, step: LessonStep, folder: Path) -> str:
    """Tries regular polygons of 2 to 12 corners."""
    taken = [count for count in range(2, 13) if reads_polygon(folder, count)]
    assert taken == list(range(taken[0], taken[-1] + 1))
    return f"a polygon of {taken[0]} to {taken[-1]} corners"


def reads_polygon(folder: Path, corners: int) -> bool:
    angles = np.linspace(0, math.tau, corners, endpoint=False)
    points = [[round(math.cos(a), 6), round(math.sin(a), 6)] for a in angles]
    footprint = {"type": "polygon", "density": 1, "points": points}
    try:
        Workshop(folder).world({"robot": {"bodies": [{"name": "base", "footprints": [footprint]}]}})
    except WorldError:
        return False
    return True


def trailer_pose(words: str, step: LessonStep, folder: Path) -> str:
    file = solutions_folder() / "06-models-and-plugins" / "porter" / "solution" / "porter.model.yaml"
    bodies = {body["name"]: body for body in yaml.safe_load(file.read_text())["bodies"]}
    return f"its middle {-bodies['trailer']['pose'][0]:g} m behind the origin"


def squared_error(words: str, step: LessonStep, folder: Path) -> str:
    """The square of the standard deviation in the line above."""
    return f"{round(0.03**2, 6)} m squared"


def two_crates(words: str, step: LessonStep, folder: Path) -> str:
    """Drives the scene: where does the robot stop?"""
    assert step.scene is not None
    world = load_world(Path(step.scene.map_name))
    x = {model.name: model.pose.x for model in world.models}
    told = shell(
        "run",
        step.scene.map_name,
        "--controller",
        step.scene.controller,
        "--steps",
        str(round(step.scene.seconds / STEP_S)),
    )
    pose = re.search(rf"end +x ({NUMBER}) m", told)
    assert pose is not None, told
    assert x["first"] < float(pose[1]) < x["second"], told
    return "It passes through the first crate and stops at the second."


def layer_case(name: str) -> LayerCase:
    file = {
        "warehouse": "08-fewest-layers/warehouse/warehouse.layers.yaml",
        "yard": "08-fewest-layers/yard/yard.layers.yaml",
    }
    return open_task(str(lessons_folder() / file[name]) if name in file else name).case


def greedy_layers(words: str, step: LessonStep, folder: Path) -> str:
    size = run_greedy(layer_case("greedy-trap")).size
    assert step.text.count("{") == size
    return f"It ends with { {4: 'four'}[size] } layers"


def greedy_size(words: str, step: LessonStep, folder: Path) -> str:
    case = layer_case("greedy-trap")
    things = {name for edge in case.collide for name in (edge.a, edge.b)}
    return f"{ {6: 'Six'}[len(things)] } things, { {9: 'nine'}[len(case.collide)] } edges"


def fewest_greedy_trap(words: str, step: LessonStep, folder: Path) -> str:
    plan = solve_layers(layer_case("greedy-trap"))
    assert plan.is_optimal
    return f"A plan with { {3: 'three'}[len(plan.assignment.layers)] } is therefore the best there is."


def fewest_yard(words: str, step: LessonStep, folder: Path) -> str:
    plan = solve_layers(layer_case("yard"))
    assert plan.is_optimal
    return f"Fewer than { {10: 'ten'}[len(plan.assignment.layers)] } are impossible here"


def yard_size(words: str, step: LessonStep, folder: Path) -> str:
    case = layer_case("yard")
    dots = {name for edge in case.collide for name in (edge.a, edge.b)}
    return f"{ {8: 'eight'}[len(dots)] } dots and { {12: 'twelve'}[len(case.collide)] } edges"


# Lesson 9: controllers


@cache
def bumps_of(place: str, seed: int) -> int:
    """Bumps of ``avoid`` in 20 s, by the command that the lesson has students run."""
    told = shell("run", place, "--controller", "avoid", "--steps", "2000", "--seed", str(seed))
    found = re.search(r"(\d+) bumps?", told)
    assert found is not None, told
    return int(found[1])


def bumps_of_avoid(words: str, step: LessonStep, folder: Path) -> str:
    if "simple" in words:
        assert bumps_of("simple", 1) == 0
        return "In the simple room it drives for 20 s without a bump"
    if "14" in words:
        return f"{bumps_of('house', 1)} times with this seed, and {bumps_of('house', 0)} with seed 0"
    assert bumps_of("racetrack", 0) == 0
    return f"seed 1 gives {bumps_of('racetrack', 1)} bumps and seed 0 none"


def example_source(name: str) -> str:
    return find_controller(name).file.read_text()


def speed_of_forward(words: str, step: LessonStep, folder: Path) -> str:
    """Its speed while nothing is in the way."""
    with Session(scenario_on_map(find_map("racetrack")), seed=1) as session:
        assert session.scenario.robot is not None
        session.drive_with(find_controller("forward"))
        session.wait_until_driven()
        places = []
        for _ in range(100):
            session.runner.tick()
            places.append(session.runner.simulation.pose(session.scenario.robot))
    speeds = [math.dist(a[:2], b[:2]) / STEP_S for a, b in pairwise(places)]
    return f"drive forward at {max(speeds):.1f} m/s"


def forward_at_the_wall(words: str, step: LessonStep, folder: Path) -> str:
    """In the scene: it stands at the end, and touches a wall."""
    assert step.scene is not None
    with Session(scenario_on_map(find_map(step.scene.map_name)), seed=step.scene.seed) as session:
        assert session.scenario.robot is not None
        session.drive_with(find_controller(step.scene.controller))
        session.wait_until_driven()
        places = []
        for _ in range(round(step.scene.seconds / STEP_S)):
            session.runner.tick()
            places.append(session.runner.simulation.pose(session.scenario.robot))
        touched = session.metrics.metrics.bumps
    assert touched
    assert math.dist(places[0][:2], places[-1][:2]) > 0.1
    assert math.dist(places[-1][:2], places[-100][:2]) < 0.1
    return "It stands at the wall, its wheels still driving."


def avoid_rule(words: str, step: LessonStep, folder: Path) -> str:
    source = example_source("avoid")
    limit, turn, speed = (
        float(found[1])
        for found in (
            re.search(rf"ahead < ({NUMBER})", source),
            re.search(rf"angular\.z = ({NUMBER})", source),
            re.search(rf"linear\.x = ({NUMBER})", source),
        )
        if found is not None
    )
    side = "right" if turn < 0 else "left"
    return f"Below { {1: 'one'}[round(limit)] } metre it turns to the {side}, else it drives at {speed:g} m/s"


def avoid_and_nan(words: str, step: LessonStep, folder: Path) -> str:
    """On open floor, where the ray ahead reads nan, it turns and does not drive."""
    Workshop(folder).serp([(50, -1, 50, 1)])
    told = shell("run", str(folder / "world.yaml"), "--controller", "avoid", "--steps", "300")
    assert re.search(r"distance +0\.00 m", told), told
    return "free space, which `avoid` takes for a wall"


def width_of_the_robot(words: str, step: LessonStep, folder: Path) -> str:
    card = find_map("house")
    world = load_world(card.world_file, root=card.root)
    (robot,) = (model for model in world.models if model.name == "serp")
    y = [
        footprint_y + body.pose.y
        for body in robot.bodies
        for footprint in body.footprints
        if isinstance(footprint.shape, Polygon)
        for _, footprint_y in footprint.shape.points
    ]
    return f"the robot is {100 * (max(y) - min(y)):.0f} cm wide"


def steps_in_seconds(words: str, step: LessonStep, folder: Path) -> str:
    return f"2000 steps are {2000 * STEP_S:g} s in the world"


def starter_rays(words: str, step: LessonStep, folder: Path) -> str:
    (file,) = exercise_folder("09-your-own-controller/wanderer").glob("starter*")
    found = re.search(r"nearest\(scan\.ranges\[(\d+):(\d+)\]\)", file.read_text())
    assert found is not None
    low, high = int(found[1]), int(found[2])
    return f"looks at {high - low} rays at once"


RAY_ABEAM = 22.5
"""Where the kit's laser of 91 rays, 4 degrees apart and the middle one straight ahead, would have a ray straight to the right."""


def ray_abeam(words: str, step: LessonStep, folder: Path) -> str:
    """The rays to both sides of straight to the right."""
    return f"between ray {math.floor(RAY_ABEAM)} and ray {math.ceil(RAY_ABEAM)}"


def askew_at_a_ray(words: str, step: LessonStep, folder: Path) -> str:
    (ray,) = re.findall(r"nearest is ray (\d+)", words)
    degrees = 4 * (int(ray) - RAY_ABEAM)
    return f"If the nearest is ray {ray}, askew is {degrees:g} degrees, or {math.radians(degrees):.2f} rad"


def radian(words: str, step: LessonStep, folder: Path) -> str:
    return f"turns by 1 rad, about {math.degrees(1):.0f} degrees"


# Lessons 10 to 12: environments, rewards, trainings


def turn_actions(words: str, step: LessonStep, folder: Path) -> str:
    return f"there is no {TurnEnv().action_space.n}"


def discounted_sum(words: str, step: LessonStep, folder: Path) -> str:
    powers = [f"{0.9**n:.3g}" for n in range(3)]
    return f"With a discount of 0.9, rewards of 1, 1, 1 have the return {' + '.join(powers)}"


def turn_ends(words: str, step: LessonStep, folder: Path) -> str:
    """An episode of turning on the spot."""
    env = TurnEnv()
    env.reset(seed=0)
    steps = truncated = 0
    while not truncated:
        _, _, terminated, truncated, _ = env.step(np.int64(1))
        assert not terminated
        steps += 1
    return re.sub(r"\d+", str(steps), words)


def minutes_of_steps(words: str, step: LessonStep, folder: Path) -> str:
    return f"25,000 steps are {25_000 * DECISION_S / 60:.0f} minutes of a robot's time"


def nearness_pay(words: str, step: LessonStep, folder: Path) -> str:
    pay = [1.0 / (1.0 + distance) for distance in (0, 1, 2)]
    assert pay == sorted(pay, reverse=True)
    return f"At the target the distance is 0 and the pay is {pay[0]:g}"


def grid_steps(words: str, step: LessonStep, folder: Path) -> str:
    task = yaml.safe_load((exercise_folder("11-rewards/too_near") / "assignment.yaml").read_text())
    return f"after {task['grid']['max_steps']} steps"


def told_of_starter(exercise: str, folder: Path) -> str:
    """What is said of a starter of the rewards' lesson if what a perfect learner does ends no judging."""
    copy = shutil.copytree(exercise_folder(f"11-rewards/{exercise}"), folder / exercise)
    task = copy / "assignment.yaml"
    task.write_text(task.read_text().replace("    after: planned\n", ""))
    assignment = read_assignment(copy)
    (starter,) = copy.glob("starter*")
    result = grade(assignment, read_submission(starter, assignment.submit), GradingOptions(Level.LIMITED))
    return "\n".join(each.rationale for each in result.tests)


def too_near_returns(words: str, step: LessonStep, folder: Path) -> str:
    """The starter of the exercise is this reward; the grader says what whole drives earn by it."""
    told = told_of_starter("too_near", folder)
    found = re.search(rf"pays ({NUMBER}) for driving to the target, but ({NUMBER})", told)
    assert found is not None, told
    return f"earns {found[1]} here" if "here" in words else f"earns {found[2]}"


def to_and_fro_returns(words: str, step: LessonStep, folder: Path) -> str:
    told = told_of_starter("to_and_fro", folder)
    found = re.search(rf"ever earns ({NUMBER}), driving to the target only ({NUMBER})", told)
    assert found is not None, told
    return f"Over an episode that loop earns {found[1]}, driving to the target only {found[2]}."


def reward_budget(words: str, step: LessonStep, folder: Path) -> str:
    task = yaml.safe_load((exercise_folder("11-rewards/your_reward") / "assignment.yaml").read_text())
    (trained,) = (check for check in task["checks"] if check["check"] == "trained")
    steps = f"{trained['with']['steps']:,} steps"
    if "45" in words:
        share = round(100 * trained["share"]["full"])
        return f"gets {steps} in the corridor with the corner and must then arrive in {share} % of its drives"
    return f"has {steps} of a tenth of a second"


def sparse_reward(words: str, step: LessonStep, folder: Path) -> str:
    """Graded as the exercise: right by the perfect learner, and hardly ever there after training."""
    copy = shutil.copytree(exercise_folder("11-rewards/your_reward"), folder / "task")
    file = folder / "reward.py"
    file.write_text("def reward(reached, collided):\n    return 10.0 * reached - 10.0 * collided - 0.1\n")
    assignment = read_assignment(copy)
    result = grade(assignment, read_submission(file, assignment.submit), GradingOptions(Level.LIMITED))
    by_name = {each.id: each for each in result.tests}
    assert by_name["planned"].is_passed
    found = re.search(rf"({NUMBER}) % of its episodes", by_name["trained"].rationale)
    assert found is not None, by_name["trained"]
    assert float(found[1]) < 10
    return "Rarely or never to the target."


def crash_in_steps(words: str, step: LessonStep, folder: Path) -> str:
    found = re.search(
        rf"takes ({NUMBER}) for a collision and ({NUMBER}) for every step", " ".join(step.text.split())
    )
    assert found is not None
    return f"a crash costs as much as { {100: 'a hundred'}[round(float(found[1]) / float(found[2]))] } steps"


def algorithm_3(words: str, step: LessonStep, folder: Path) -> str:
    """What episodes of the turn task earn, term by term."""
    weights = {weight.term: weight.value for weight in ALGORITHM_3.weights}
    texts = {
        "reached": f"reached {weights['reached']:+g}",
        "collided": f"collided {weights['collided']:+g}",
        "steps": f"steps left {weights['time_left']:+g} for each",
        "timed": f"timed out {weights['timed_out']:+g}",
        "forward": f"forward {weights['forward'] / TURN.max_steps:+g} for a step ahead",
    }
    return texts[words.split()[0]]


HASTY: Final = "12-training-strategies/stop"


def hasty_settings(words: str, step: LessonStep, folder: Path) -> str:
    settings = yaml.safe_load((exercise_folder(HASTY) / "starter.yaml").read_text())
    if "learn" in words:
        return f"learn {settings['batch']:,} steps, test {settings['test_episodes']} episodes"
    return f"at least {settings['goal']} of the episodes arrive"


def train(folder: Path, settings: Path) -> TrainingResults:
    """What the trainings of an assignment find with these settings, on its public seeds."""
    record = collect_evidence(read_assignment(folder), settings, EvidenceOptions(Level.LIMITED, secret=False))
    assert record.failure is None, record.failure
    results: TrainingResults = record.content
    return results


@cache
def hasty_results() -> TrainingResults:
    return train(exercise_folder(HASTY), exercise_folder(HASTY) / "starter.yaml")


def hasty_trainings(words: str, step: LessonStep, folder: Path) -> str:
    """The exercise's untouched starter is the training of the first screen."""
    trainings = hasty_results().trainings
    if "exam of" in words:
        (episodes,) = {sum(count.episodes for count in each.exam.values()) for each in trainings}
        return f"an exam of {episodes} fresh episodes"
    if "4 out of 4" in words:
        assert {each.claimed for each in trainings} == {1.0}
        steps = sorted(round(each.steps, -3) for each in trainings)
        return f"4 out of 4, after {steps[0]:,} to {steps[-1]:,} steps"
    shares = sorted(f"{each.accuracy:.2f}" for each in trainings)
    return f"{', '.join(shares[:-1])} and {shares[-1]}"


FALLING_SEED: Final = 15
"""Of 24 seeds that were tried, one whose tests are good three times in a row before they fall."""
FALLING: Final = """\
algorithm: q-learning
learning_rate: [0.3, 0.3]
exploration: [0.3, 0.02]
discount: 0.99
batch: 10000
test_episodes: 20
stop: never
keep: newest
steps: 100000
"""


@cache
def falling_tests() -> tuple[tuple[int, float, float], ...]:
    """Of each test: steps, and the shares of right and left turns."""
    with TemporaryDirectory() as name:
        copy = shutil.copytree(exercise_folder(HASTY), Path(name) / "task")
        (copy / "secret.yaml").unlink()
        task = copy / "assignment.yaml"
        task.write_text(re.sub(r"seeds: \[.*\]", f"seeds: [{FALLING_SEED}]", task.read_text()))
        settings = Path(name) / "training.yaml"
        settings.write_text(FALLING)
        results = train(copy, settings)
    (training,) = results.trainings
    right, left = results.budget.cases
    assert {count.episodes for test in training.tests for count in test.counts.values()} == {10}
    return tuple(
        (round(test.steps, -4), test.counts[right].share, test.counts[left].share) for test in training.tests
    )


def falling_test(words: str, step: LessonStep, folder: Path) -> str:
    """The rows of the picture, and what came after."""
    rows = {steps: shares for steps, *shares in falling_tests()}
    if "episodes" in words:
        return "10 episodes for each direction"
    if words.startswith("at"):
        assert rows[90_000] == [1.0, 1.0]
        return "at 90,000 all was well again"
    if "and" in words:
        return " and ".join(f"{share:.2f}" for share in rows[80_000])
    steps = int(words.split()[0].replace(",", ""))
    return " ".join(f"{steps:,} {' '.join(f'{bar(share)} {share:.2f}' for share in rows[steps])}".split())


def bar(share: float) -> str:
    return "#" * round(7 * share)


def four_of_four(words: str, step: LessonStep, folder: Path) -> str:
    if "0.7" in words:
        return f"A policy with 0.7 also gets four out of four, in one test out of { {4: 'four'}[round(1 / 0.7**4)] }"
    return f"once in { {16: 'sixteen'}[round(1 / 0.5**4)] }"


def wilson(words: str, step: LessonStep, folder: Path) -> str:
    reached, episodes = re.findall(r"\d+", words)[:2]
    return f"{reached} of {episodes} {lower_bound(int(reached), int(episodes)):.2f}"


def lucky_test(words: str, step: LessonStep, folder: Path) -> str:
    """Of 20 episodes with 0.7 each, 16 or more arrive: in one test, and in one of ten."""
    one = sum(math.comb(20, k) * 0.7**k * 0.3 ** (20 - k) for k in range(16, 21))
    ten = 1 - (1 - one) ** 10
    return f"in {100 * one:.0f} % of all tries, but in {100 * ten:.0f} % of all trainings that try ten times"


def dead_end(words: str, step: LessonStep, folder: Path) -> str:
    told = shell("fields", "show", "pair_turn_180", "--plain")
    assert "trap (!)" in told
    assert "the forces do not lead to the target" in told
    return "the field leads into a dead end, whatever the intensities"


DERIVATIONS: Final[Mapping[str, Claim]] = MappingProxyType(
    {
        claim.__name__.replace("_", "-"): claim
        for claim in (
            given,
            laser_rate,
            teleop_near_walls,
            keystrokes,
            stumbles_after,
            move_fields,
            real_time,
            pause_holds,
            random_walk_set,
            map_right_side,
            map_divided,
            starter_hall,
            hall_pixels,
            thin_line,
            pen_wall,
            all_mistakes,
            plugin_topics,
            polygon_corners,
            trailer_pose,
            squared_error,
            two_crates,
            greedy_layers,
            greedy_size,
            fewest_greedy_trap,
            fewest_yard,
            yard_size,
            bumps_of_avoid,
            speed_of_forward,
            forward_at_the_wall,
            avoid_rule,
            avoid_and_nan,
            width_of_the_robot,
            steps_in_seconds,
            starter_rays,
            ray_abeam,
            askew_at_a_ray,
            radian,
            turn_actions,
            discounted_sum,
            turn_ends,
            minutes_of_steps,
            nearness_pay,
            grid_steps,
            too_near_returns,
            to_and_fro_returns,
            reward_budget,
            sparse_reward,
            crash_in_steps,
            algorithm_3,
            hasty_settings,
            hasty_trainings,
            falling_test,
            four_of_four,
            wilson,
            lucky_test,
            dead_end,
            *TABLE_DERIVATIONS,
            *NETWORK_DERIVATIONS,
            *GENERALISATION_DERIVATIONS,
            *FOLLOWER_DERIVATIONS,
            *CAPSTONE_DERIVATIONS,
            *IMITATION_DERIVATIONS,
            *OWN_TASK_DERIVATIONS,
            *POLICY_DERIVATIONS,
            *FAILURE_DERIVATIONS,
        )
    }
)
"""By the name that a claim's ``derived`` gives."""
DEAR: Final = frozenset(
    {
        "found-by-sixty",
        "one-sided",
        "one-world",
        "without-buffer",
        "without-copy",
        "without-clipping",
        "while-learning",
        "cliff-tested",
        "sparse-reward",
        "hasty-trainings",
        "falling-test",
        "bumps-of-avoid",
        "dead-end",
        "to-and-fro-returns",
        "too-near-returns",
        "sure-of-the-way",
        "swing",
        "pd-stays",
        "careful-or-not",
        "cliff-paths",
        "teleop-near-walls",
        *FAILURE_DEAR,
    }
)
"""Those that take more than a fifth of a second: they run with the long tests."""
