"""One drive: who drives, what becomes of the robot when nobody does, the score, and runs without a screen."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from kit.controllers import find_controller, kit_controllers, prepare_workspace, user_controllers
from kit.plain_text import format_clock
from kit.run.headless import run_headless
from kit.run.recording import load_recording, rerun
from kit.run.recording_file import RecordingFile
from kit.run.scenario import find_scenario, scenario_on_map
from kit.run.session import Session
from kit.run.view import ROBOT_SIDES, ViewBuilder
from kit.world.catalogue import UnknownMap, find_map
from tests.driving_program import driving_program
from tests.kit_content import kit_maps


def write(folder: Path, speed: float = 0.2, then: str = "") -> Path:
    file = folder / "driver.py"
    file.write_text(driving_program(speed, then=then, period_s=0.05))
    return file


def run(session: Session, seconds: float, *, until: Callable[[], object] | None = None) -> None:
    """Ticks, looking around as a face does. With ``until``, as long as it takes, within reason."""
    end = time.monotonic() + 20
    ticks = round(seconds / 0.01)
    while ticks > 0 or (until is not None and not until()):
        session.runner.tick()
        session.poll()
        ticks -= 1
        if ticks <= 0 and until is not None:
            time.sleep(0.002)
            assert time.monotonic() < end


def speed(session: Session) -> float:
    assert session.scenario.robot
    vx, vy, _ = session.runner.simulation.state().bodies[0].velocity
    return float(np.hypot(vx, vy))


@pytest.mark.long_cases("abreast", "fields")
@pytest.mark.parametrize("name", [each.name for each in kit_controllers()])
def test_every_controller_of_the_kit_drives(name: str) -> None:
    with Session(scenario_on_map(find_map("simple")), seed=1) as session:
        session.drive_with(find_controller(name))
        session.wait_until_driven()
        session.keys.publish(["p_up"])
        run(session, 8.0)  # some turn on the spot first
        assert session.failure is None
        assert session.metrics.metrics.distance_m > 0.3


def test_the_template_runs_and_does_nothing_yet(tmp_path: Path) -> None:
    desk = prepare_workspace(tmp_path / "desk")
    (mine,) = user_controllers(desk.controllers)
    with Session(scenario_on_map(find_map("simple"))) as session:
        session.drive_with(mine)
        session.wait_until_driven()
        run(session, 1.0)
        assert session.failure is None
        assert session.metrics.metrics.distance_m == 0.0
    mine.file.write_text("# mine\n")
    assert (
        user_controllers(prepare_workspace(tmp_path / "desk").controllers)[0].file.read_text() == "# mine\n"
    )


def test_the_robot_stops_when_its_controller_does(tmp_path: Path) -> None:
    with Session(scenario_on_map(find_map("simple"))) as session:
        file = write(tmp_path, 0.2, "if self.count == 10: raise ValueError('tired')")
        session.drive_with(find_controller(str(file)))
        session.wait_until_driven()
        run(session, 0.3)
        assert speed(session) == pytest.approx(0.2, abs=1e-6)
        run(session, 0.6)
        assert session.failure is not None
        assert "tired" in str(session.failure)
        (line,) = (at for at, text in enumerate(file.read_text().splitlines(), 1) if "tired" in text)
        assert session.failure.line == line
        assert speed(session) == pytest.approx(0.0, abs=1e-9)


def test_nobody_drives_any_more(tmp_path: Path) -> None:
    with Session(scenario_on_map(find_map("simple"))) as session:
        session.drive_with(find_controller(str(write(tmp_path))))
        session.wait_until_driven()
        run(session, 0.2)
        session.drive_with(None)
        run(session, 0.05)
        assert speed(session) == pytest.approx(0.0, abs=1e-9)
        assert session.controller is None


@pytest.mark.long
def test_a_broken_new_version_leaves_the_old_one_at_the_wheel(tmp_path: Path) -> None:
    with Session(scenario_on_map(find_map("simple"))) as session:
        file = write(tmp_path, 0.1)
        session.drive_with(find_controller(str(file)))
        session.wait_until_driven()
        run(session, 0.2)
        file.write_text("def broken(:\n")
        run(session, 0.1, until=lambda: session.failure)
        run(session, 0.1)
        assert speed(session) == pytest.approx(0.1, abs=1e-6)
        write(tmp_path, 0.15)
        run(session, 0.1, until=lambda: session.failure is None)
        run(session, 0.2, until=lambda: abs(speed(session) - 0.15) < 1e-6)
        heard = [record.text for record in session.messages]
        assert any(text.startswith(f"reloaded {file.name}") for text in heard)
        assert not any("already a node" in text for text in heard)  # the old one had not gone yet


def test_what_a_controller_prints_and_logs_is_heard(tmp_path: Path) -> None:
    more = "print('by hand') if self.count == 1 else self.get_logger().warning('by the logger')"
    with Session(scenario_on_map(find_map("simple"))) as session:
        session.drive_with(find_controller(str(write(tmp_path, 0.1, more))))
        session.wait_until_driven()
        run(session, 0.5, until=lambda: len(session.messages) > 3)
        heard = {(record.name, record.severity.name, record.text) for record in session.messages}
        assert ("driver", "INFO", "by hand") in heard
        assert ("driver", "WARN", "by the logger") in heard


def test_keys_pressed_before_the_listener_came_are_told_to_it() -> None:
    with Session(scenario_on_map(find_map("simple"))) as session:
        session.keys.publish(["p_up", "p_left", "r_left"])
        session.drive_with(find_controller("teleop"))
        session.wait_until_driven()
        run(session, 0.3)
        assert speed(session) == pytest.approx(0.5, abs=1e-6)
        session.keys.publish(["r_up"])
        run(session, 0.05)
        assert speed(session) == pytest.approx(0.0, abs=1e-9)


def test_teleop_slows_near_a_wall_and_goes_home_after_a_bump() -> None:
    with Session(scenario_on_map(find_map("maze"))) as session:
        session.drive_with(find_controller("teleop"))
        session.wait_until_driven()
        start = session.runner.simulation.pose("serp")
        session.keys.publish(["p_up"])
        slowest = 1.0
        for _ in range(1500):
            run(session, 0.01)
            if session.metrics.metrics.bumps:
                break
            if session.metrics.metrics.distance_m > 0.2:
                slowest = min(slowest, speed(session))
        assert slowest == pytest.approx(0.25, abs=1e-3)
        assert session.metrics.metrics.bumps == 1
        run(session, 0.1)
        assert session.runner.simulation.pose("serp") == pytest.approx(start, abs=1e-6)
        assert any("front" in record.text for record in session.messages)


def test_a_reset_starts_everything_anew(tmp_path: Path) -> None:
    with Session(scenario_on_map(find_map("simple"))) as session:
        session.drive_with(find_controller(str(write(tmp_path, 0.3))))
        session.wait_until_driven()
        run(session, 1.0)
        assert session.metrics.metrics.distance_m > 0.2
        session.reset()
        assert session.runner.simulation.tick == 0
        session.wait_until_driven()
        run(session, 0.5)
        assert session.metrics.metrics.distance_m == pytest.approx(0.15, abs=0.03)


@pytest.mark.long
def test_the_same_run_to_the_bit_and_another_seed_another() -> None:
    def fingerprint(seed: int) -> str:
        return run_headless(
            find_scenario("maze"), find_controller("random_walk"), steps=1500, seed=seed
        ).fingerprint

    assert fingerprint(3) == fingerprint(3) != fingerprint(4)


def test_a_run_is_recorded_and_runs_again(tmp_path: Path) -> None:
    file = tmp_path / "run.npz"
    run_headless(
        find_scenario("maze"), find_controller("random_walk"), steps=1200, seed=2, record=RecordingFile(file)
    )
    recording = load_recording(file)
    again = rerun(recording, find_scenario(recording.place, recording.case).world)
    assert np.array_equal(again.poses, recording.poses)


def test_the_target_is_reached_by_the_hull(tmp_path: Path) -> None:
    scenario = find_scenario("hall_straight")
    summary = run_headless(
        scenario, find_controller(str(write(tmp_path, 0.3))), steps=2000, until_reached=True
    )
    assert scenario.case is not None
    assert summary.metrics.reached_s is not None
    assert summary.metrics.target_m == pytest.approx(scenario.case.target_radius, abs=0.01)
    assert summary.pose is not None
    # the nose is 0.048 m ahead of the axle, from which the pose counts
    ahead = scenario.case.target[1] - summary.pose.y
    assert ahead == pytest.approx(scenario.case.target_radius + 0.048, abs=0.01)


@pytest.mark.long
def test_a_controller_is_in_the_namespace_of_its_robot(tmp_path: Path) -> None:
    with Session(scenario_on_map(find_map("pair_straight"))) as session:
        session.drive_with(find_controller(str(write(tmp_path))))
        session.wait_until_driven()
        run(session, 1.0)
        assert session.metrics.metrics.distance_m == pytest.approx(0.2, abs=0.03)
        session.drive_with(find_controller("teleop"))
        session.wait_until_driven()
        session.keys.publish(["p_up"])
        run(session, 0.5)
        assert session.metrics.metrics.distance_m == pytest.approx(0.45, abs=0.06)


def test_a_robots_partner_stops_with_it_when_nobody_drives(tmp_path: Path) -> None:
    both = (
        "from rclpy.node import Node as N; "
        "self.right = getattr(self, 'right', None) or self.create_publisher(Twist, '/right/cmd_vel', 10); "
        "self.right.publish(command)"
    )
    with Session(scenario_on_map(find_map("pair_straight"))) as session:
        session.drive_with(find_controller(str(write(tmp_path, 0.2, both))))
        session.wait_until_driven()
        run(session, 0.5)
        assert abs(session.runner.simulation.state().bodies[1].velocity[1]) > 0.1
        session.drive_with(None)
        run(session, 0.1)
        assert [round(abs(body.velocity[1]), 6) for body in session.runner.simulation.state().bodies[:2]] == [
            0,
            0,
        ]


@pytest.mark.long
def test_hanging_up_frees_a_tick_that_waits_for_a_controller(tmp_path: Path) -> None:
    with Session(scenario_on_map(find_map("simple"))) as session:
        session.drive_with(find_controller(str(write(tmp_path, 0.2, "while self.count == 3: pass"))))
        session.wait_until_driven()
        timer = threading.Timer(0.5, session.disconnect)
        timer.start()
        start = time.monotonic()
        run(session, 1.0)
        assert time.monotonic() - start < 2.5  # and not the three seconds that a reply may take
        assert session.failure is not None


def test_a_robot_that_is_put_elsewhere_has_not_driven_there() -> None:
    with Session(scenario_on_map(find_map("simple"))) as session:
        run(session, 0.05)
        for x in (0.01, 0.5, -0.5):
            session.runner.call_service("move_model", "serp", (x, 0.0, 0.0))
            run(session, 0.02)
        assert session.metrics.metrics.distance_m == pytest.approx(0.0, abs=1e-9)


def test_the_drivers_stand_in_the_order_of_the_file() -> None:
    scenario = scenario_on_map(find_map("pair_straight"))
    models = scenario.world.models
    more = tuple(replace(models[0], name=f"r{i}", namespace=f"r{i}") for i in range(20))
    crowd = replace(scenario, world=replace(scenario.world, models=(*more, *models)), case=None)
    assert crowd.drivers == (crowd.robot, *(model.name for model in more), "right")
    assert crowd.partners == (crowd.robot, "r0")


def test_a_map_goes_before_a_folder_of_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "maze").mkdir()
    (tmp_path / "maze" / "world.yaml").write_text("properties: {}\nlayers: []\n")
    monkeypatch.chdir(tmp_path)
    assert find_scenario("maze").case is not None
    assert find_scenario("./maze").case is None


def test_a_place_is_found_by_name_case_folder_or_file() -> None:
    card = find_map("turn")
    assert find_scenario("turn").case == card.cases[0]
    assert find_scenario("turn", card.cases[1].name).case == card.cases[1]
    assert find_scenario("turn", card.cases[1].name).start == card.cases[1].start
    assert find_scenario(str(card.folder), root=card.root).robot == "serp"
    assert find_scenario(str(card.world_file), root=card.root).world.models
    with pytest.raises(LookupError, match="turn_a_to_b"):
        find_scenario("turn", "nowhere")
    with pytest.raises(UnknownMap, match="maze"):
        find_scenario("maz")


@pytest.mark.parametrize("card", kit_maps(), ids=lambda card: card.name)
def test_every_case_of_every_map_can_be_shown(card: object) -> None:
    from kit.world.catalogue import MapCard

    assert isinstance(card, MapCard)
    for case in card.cases:
        with Session(scenario_on_map(card, case), always_scan=True) as session:
            session.runner.tick()
            view = ViewBuilder(session).build()
        assert view.pose == pytest.approx(case.start, abs=1e-6)
        assert view.scene.robots
        assert [side for side, _ in view.nearest] == [side for side, _ in ROBOT_SIDES]


@pytest.mark.parametrize(
    ("seconds", "digits", "text"),
    [(0.0, 1, "0:00.0"), (59.99, 1, "0:59.9"), (60.0, 1, "1:00.0"), (61.234, 2, "1:01.23")],
)
def test_clock(seconds: float, digits: int, text: str) -> None:
    assert format_clock(seconds, digits) == text
