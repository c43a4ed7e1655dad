"""Messages from their bytes. What lcm-gen writes has no types that hold, so none are asked of it here."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from .grid_t import grid_t
from .health_t import health_t
from .obstacle_list_t import obstacle_list_t


def _decoder(kind: Any) -> Callable[[bytes], Any]:
    decode: Callable[[bytes], Any] = kind.decode
    return decode


decode_grid, decode_health, decode_list = map(_decoder, (grid_t, health_t, obstacle_list_t))
