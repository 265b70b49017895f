"""A ROS 2 node that drives a robot, graded on episodes that the grader runs and records."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Final

from grader.assignment import Assignment, Shift, Trial
from grader.driving.check_table import CHECKS
from grader.driving.service_calls import read_service_call
from grader.evidence.contract import (
    EpisodeCollector,
    EpisodeSpec,
    Evidence,
    EvidenceCollector,
    EvidenceOptions,
)
from grader.kinds.contract import AssignmentFiles, KindSettings, SubmissionKind
from grader.kinds.controller.sheet_keys import SHEET_KEYS
from grader.seeds import read_seeds
from kit.geometry import Pose
from kit.plain_text import quoted, suggestion
from kit.run.runner import is_truth_named
from kit.run.scenario import Scenario, find_scenario
from kit.sim.simulation import SERVICES, Simulation
from kit.world.catalogue import MapCase
from kit.world.problems import WorldError
from kit.world.yaml_section import Section

MAX_EPISODE_S: Final = 3600.0
"""s"""
TRIAL_SERVICES: Final = (*SERVICES, "get_state")
"""World services that a trial may allow."""


def read_settings(files: AssignmentFiles) -> KindSettings:
    """Reads the trials."""
    return KindSettings(trials=tuple(trials(files)))


def collect(
    assignment: Assignment, file: Path, options: EvidenceOptions
) -> AbstractContextManager[EvidenceCollector]:
    """Runs each episode when a criterion first needs it."""
    from grader.driving.episodes import ProgramLoading, run_episode

    loading = ProgramLoading()

    def run(spec: EpisodeSpec) -> Evidence:
        return run_episode(
            spec,
            file,
            limits=assignment.limits,
            level=options.level,
            clock=options.clock,
            loading=loading,
        )

    return nullcontext(EpisodeCollector(assignment, options, run))


def trials(files: AssignmentFiles) -> Iterator[Trial]:
    """Yields the trials of the assignment."""
    section, secrets, folder = files.public, files.secret, files.folder
    names: set[str] = set()
    hidden = None if secrets is None else secrets.section("seeds")
    for each in section.sections("trials", at_least=1):
        name = each.name("name")
        if name in names:
            each.error(f"a trial named {quoted(name)} already exists", "name")
        names.add(name)
        scenario = read_scenario(each, folder)
        time_s = each.number("time", 60.0, above=0, maximum=MAX_EPISODE_S)
        seeds = read_seeds(each, "seeds", (1, 2, 3))
        shift = Shift(*each.numbers("shift", (0.0, 0.0, 0.0), length=3))
        noise = each.number("noise", minimum=0, maximum=10) if each.has("noise") else None
        laser_range = each.number("range", above=0, maximum=1000) if each.has("range") else None
        until = each.flag("until_reached", True)
        services = each.texts("services", ("move_model",))
        for service in services:
            if service not in TRIAL_SERVICES:
                each.error(f"no service {quoted(service)}: {suggestion(service, TRIAL_SERVICES)}", "services")
        topics = each.texts("topics", ())
        if topics and scenario is not None:
            _check_truths(each, scenario, topics)
        parameters = each.texts("parameters", ())
        if any(":=" not in one for one in parameters):
            each.error("parameters look like name:=value", "parameters")
        calls = tuple(read_service_call(one) for one in each.sections("calls", ()))
        each.finish()
        secret_seeds = read_seeds(hidden, name, ()) if hidden is not None and name else ()
        if scenario is not None:
            yield Trial(
                name=name,
                scenario=scenario,
                time_s=time_s,
                seeds=seeds,
                secret_seeds=secret_seeds,
                shift=shift,
                noise=noise,
                until_reached=until,
                services=frozenset(services),
                parameters=parameters,
                topics=frozenset(topics),
                calls=calls,
                laser_range=laser_range,
            )
    if hidden is not None:
        hidden.finish()


def _check_truths(section: Section, scenario: Scenario, topics: Sequence[str]) -> None:
    """Notes each of ``topics`` that is no ground-truth topic of the scenario's world."""
    ends = Simulation(scenario.world, seed=0).endpoints
    truths = sorted({end.topic for end in ends if end.is_ground_truth})
    for topic in topics:
        if not any(is_truth_named(truth, topic) for truth in truths):
            known = suggestion(topic, truths) if truths else "this world has none"
            section.error(f"no ground-truth topic {quoted(topic)}: {known}", "topics")


def read_scenario(section: Section, folder: Path) -> Scenario | None:
    """Reads a map of the kit or a world of the folder, with its case or target; notes a mistake and returns None."""
    name = section.name("place")
    case = section.name("case") if section.has("case") else None
    target = section.point("target") if section.has("target") else None
    radius = section.number("target_radius", 0.2, above=0)
    if not name:
        return None
    try:
        inside = (folder / name).resolve()
        is_custom_interface = inside.exists() and inside.is_relative_to(folder.resolve())
        scenario = find_scenario(
            str(folder / name) if is_custom_interface else name, case, folder if is_custom_interface else None
        )
    except (LookupError, WorldError, OSError) as error:
        section.error(str(error), "place")
        return None
    if target is None:
        return scenario
    start = scenario.start or Pose()
    target_case = MapCase(
        section.name("name"), start, target, radius, (0.0, 0.0), (0.0, 0.0), False, "", None
    )
    return replace(scenario, case=target_case)


KIND: Final = SubmissionKind(
    (".py",),
    CHECKS,
    read_settings,
    collect,
    seed_decides="A seed decides where the robot starts, the noise of its sensors, and the random numbers that a program draws.",
    sheet_keys=SHEET_KEYS,
)
