"""Scree in Python: the types of its messages, its lists as plain objects, and `subscribe`.

The submodules do the rest: `scree.read`, `scree.mcap_export`, `scree.parquet_export`,
`scree.bag_import`, `scree.fleet`. Each needs the libraries of its extra: pip install "scree[export]".
"""

# ruff: noqa: I001  (the types refer to one another by these names)
from .grid_t import grid_t
from .latency_t import latency_t
from .queue_t import queue_t
from .sensor_health_t import sensor_health_t
from .stage_t import stage_t
from .thread_t import thread_t
from .health_t import health_t
from .obstacle_t import obstacle_t
from .obstacle_list_t import obstacle_list_t

from .records import Grid, Obstacle, ObstacleList, Pose
from .subscription import Subscription, View, subscribe

__version__ = "0.1.0"
__all__ = [
    "Grid",
    "Obstacle",
    "ObstacleList",
    "Pose",
    "Subscription",
    "View",
    "grid_t",
    "health_t",
    "latency_t",
    "obstacle_list_t",
    "obstacle_t",
    "queue_t",
    "sensor_health_t",
    "stage_t",
    "subscribe",
    "thread_t",
]
