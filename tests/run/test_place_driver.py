"""A robot that is sent to a place: it gets there without a bump, yields to whoever drives, and says where no way leads."""

from __future__ import annotations

import math

import pytest

from kit.controllers import find_controller
from kit.geometry import Pose
from kit.mapmaking.route import NoRoute
from kit.run.episode import run_until
from kit.run.place_driver import ARRIVAL, PlaceDriver
from kit.run.scenario import find_scenario
from kit.run.session import Session

pytestmark = pytest.mark.long
PLACES = {"simple": (2.0, 1.5), "house": (2.0, -1.6)}


@pytest.mark.parametrize("place", PLACES)
def test_it_gets_there_and_touches_nothing(place: str) -> None:
    with Session(find_scenario(place)) as session:
        driver = PlaceDriver(session, PLACES[place])
        session.runner.observers.append(driver)
        run_until(session.runner, limit_s=60.0)
        assert driver.is_done
        pose = session.runner.simulation.pose(session.scenario.robot or "")
        assert math.dist(pose[:2], PLACES[place]) < 2 * ARRIVAL
        assert session.metrics.metrics.bumps == 0


def test_it_yields_to_whoever_drives() -> None:
    with Session(find_scenario("simple")) as session:
        driver = PlaceDriver(session, PLACES["simple"])
        session.runner.observers.append(driver)
        run_until(session.runner, limit_s=0.5)
        assert not driver.is_done
        session.drive_with(find_controller("circle"))
        run_until(session.runner, limit_s=0.05)
        assert driver.is_done


@pytest.mark.parametrize("heading", [-1.6, 0.0, 1.6])
def test_a_robot_beside_a_wall_drives_away_from_it(heading: float) -> None:
    """Nearer than the circle that it turns in: that is no passage that is too narrow."""
    with Session(find_scenario("simple")) as session:
        robot = session.scenario.robot or ""
        session.runner.simulation.move_model(robot, Pose(0.0, -2.29, heading))
        session.runner.observers.append(PlaceDriver(session, PLACES["simple"]))
        run_until(session.runner, limit_s=60.0)
        assert math.dist(session.runner.simulation.pose(robot)[:2], PLACES["simple"]) < 2 * ARRIVAL


def test_a_place_beside_the_robot_is_driven_to() -> None:
    with Session(find_scenario("simple")) as session:
        pose = session.runner.simulation.pose(session.scenario.robot or "")
        place = pose.x + 0.2, pose.y
        session.runner.observers.append(PlaceDriver(session, place))
        run_until(session.runner, limit_s=20.0)
        pose = session.runner.simulation.pose(session.scenario.robot or "")
        assert math.dist(pose[:2], place) < 2 * ARRIVAL


def test_there_is_no_way_out_of_the_walls() -> None:
    with Session(find_scenario("simple")) as session, pytest.raises(NoRoute):
        PlaceDriver(session, (1000.0, 1000.0))
