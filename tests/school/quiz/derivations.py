"""How an item's answer is found: by letting the kit do what the item asks about."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from tests.school.quiz.derived.actions import ACTIONS
from tests.school.quiz.derived.bags import BAGS
from tests.school.quiz.derived.capstone import CAPSTONE
from tests.school.quiz.derived.failures import FAILURES
from tests.school.quiz.derived.fields import FIELDS
from tests.school.quiz.derived.finding import Derivation
from tests.school.quiz.derived.followers import FOLLOWERS
from tests.school.quiz.derived.generalisation import GENERALISATION
from tests.school.quiz.derived.imitation import IMITATION
from tests.school.quiz.derived.layers import LAYERS
from tests.school.quiz.derived.learning import LEARNING
from tests.school.quiz.derived.localisation import LOCALISATION
from tests.school.quiz.derived.motion import MOTION
from tests.school.quiz.derived.networks import NETWORKS
from tests.school.quiz.derived.opening import OPENING
from tests.school.quiz.derived.own_tasks import OWN_TASKS
from tests.school.quiz.derived.photographs import PHOTOGRAPHS
from tests.school.quiz.derived.policies import POLICIES
from tests.school.quiz.derived.robots import ROBOTS
from tests.school.quiz.derived.service_quality import SERVICE_QUALITY
from tests.school.quiz.derived.tables import TABLES
from tests.school.quiz.derived.talk import TALK
from tests.school.quiz.derived.wheelchairs import WHEELCHAIRS
from tests.school.quiz.derived.workspaces import WORKSPACES
from tests.school.quiz.derived.worlds import WORLDS

DERIVATIONS: Final[Mapping[str, Derivation]] = MappingProxyType(
    {
        **MOTION,
        **WHEELCHAIRS,
        **TALK,
        **WORLDS,
        **LAYERS,
        **LEARNING,
        **TABLES,
        **FIELDS,
        **OPENING,
        **SERVICE_QUALITY,
        **ACTIONS,
        **NETWORKS,
        **BAGS,
        **POLICIES,
        **LOCALISATION,
        **GENERALISATION,
        **WORKSPACES,
        **PHOTOGRAPHS,
        **ROBOTS,
        **FOLLOWERS,
        **CAPSTONE,
        **IMITATION,
        **OWN_TASKS,
        **FAILURES,
    }
)
"""By the name that an item's ``derived`` gives."""
