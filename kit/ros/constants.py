"""Constants of rclpy and tf2_ros that programs import by name."""

from __future__ import annotations

from typing import Final

CLOCK_TOPIC: Final = "/clock"
USE_SIM_TIME_NAME: Final = "use_sim_time"
START_TYPE_DESCRIPTION_SERVICE_PARAM: Final = "start_type_description_service"
TF_TOPIC: Final = "/tf"
STATIC_TF_TOPIC: Final = "/tf_static"
HIDDEN_TOPIC_PREFIX: Final = "_"
NS_PER_S: Final = 1_000_000_000
