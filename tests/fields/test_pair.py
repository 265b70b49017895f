"""One step of the dissertation's pair controller, by hand."""

from __future__ import annotations

import math

import pytest

from kit.fields.charges import ChargeField, PointCharge
from kit.fields.layout import ChargeLayout, Intensities
from kit.fields.trajectory import PairSettings, VelocityCommand, control_step, drive_commands
from kit.geometry import Pose

EMPTY = ChargeLayout((), Intensities(), None, ChargeField.from_charges(()))
AHEAD = Pose(0, 0, math.pi / 2)


def abreast(gap: float = 0.3, heading: float = math.pi / 2) -> tuple[Pose, Pose]:
    return Pose(-gap / 2, 0, heading), Pose(gap / 2, 0, heading)


def test_the_steps_of_section_4_1_3_2() -> None:
    found = control_step(abreast(), (0.0, 5.0), EMPTY)
    assert found.middle == (0, 0)
    assert found.middle_force == pytest.approx((0, 0.6))  # 15 / 25
    assert found.targets[0] == pytest.approx((-0.15, 0.3))  # 0.3 m ahead at most, 0.15 m aside
    assert found.targets[1] == pytest.approx((0.15, 0.3))
    # Tension 100 * 0.3 ahead; the other robot pushes by 1 / 0.3^2 aside.
    assert found.forces[0] == pytest.approx((-1 / 0.09, 30))
    assert found.forces[1] == pytest.approx((1 / 0.09, 30))


def test_a_weak_force_leads_less_far() -> None:
    found = control_step(abreast(), (0.0, 10.0), EMPTY)
    assert found.targets[0] == pytest.approx((-0.15, 0.15))


def test_walls_push_the_middle_and_each_robot() -> None:
    charges = (PointCharge(0, -1),)
    layout = ChargeLayout(charges, Intensities(target=1e-9), None, ChargeField.from_charges(charges))
    found = control_step(abreast(), (0.0, 5.0), layout)
    assert found.middle_force == pytest.approx((0, 1))
    assert found.forces[0][1] == pytest.approx(30 + 1 / (1 + 0.15**2) ** 1.5)


def test_both_turn_before_either_drives() -> None:
    poses = (Pose(0, 0, 0), Pose(1, 0, math.pi / 2))
    found = drive_commands(poses, [(0, 1), (0, 1)], PairSettings())
    assert found == (
        VelocityCommand(0, 1.0),
        VelocityCommand(0, 0),
    )  # 5 * pi / 2, but at most 1 rad/s; the other waits


def test_near_its_heading_a_robot_turns_more_slowly_and_the_short_way() -> None:
    poses = (Pose(0, 0, math.pi / 2 + 0.1), Pose(0, 0, -math.pi + 0.05))
    found = drive_commands(poses, [(0, 1), (-1, 0)], PairSettings())
    assert found[0] == pytest.approx((0, -0.5))
    assert found[1] == pytest.approx((0, -0.25))


@pytest.mark.parametrize("tolerance", [0.019, -0.019])
def test_within_the_tolerance_the_stronger_force_gets_full_speed_and_the_other_its_share(
    tolerance: float,
) -> None:
    poses = (Pose(0, 0, math.pi / 2 + tolerance), AHEAD)
    weaker, stronger = drive_commands(poses, [(0, 2), (0, 6)], PairSettings())
    assert weaker == pytest.approx((0.1, 0))
    assert stronger == pytest.approx((0.3, 0))


def test_no_force_no_motion() -> None:
    assert drive_commands((Pose(), Pose()), [(0, 0), (0, 0)], PairSettings()) == (
        VelocityCommand(0, 0),
        VelocityCommand(0, 0),
    )


def test_one_robot_alone_follows_the_force() -> None:
    found = control_step((AHEAD,), (0.0, 3.0), EMPTY)
    assert found.forces[0] == pytest.approx((0, 15 / 9))
    assert found.commands == (VelocityCommand(0.3, 0),)
