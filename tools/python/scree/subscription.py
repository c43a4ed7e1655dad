"""What a planner in Python needs: the latest list in `base`, and whether it may be relied on."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from struct import error as StructError
from typing import Any

import lcm

from .decoding import decode_grid, decode_health, decode_list
from .records import Grid, Obstacle, ObstacleList, grid_of_message, list_of_message

DEFAULT_URL = "udpm://239.255.76.67:7667?ttl=0"
HEALTH_PATIENCE = 2.5  # seconds; it comes once a second


@dataclass(frozen=True)
class View:
    """What is known at one moment. Obstacles count only where `sees` is true."""

    stop: str  # why the robot must stop as it does not see; empty: it sees
    obstacles: tuple[Obstacle, ...]  # in `base`; none while it does not see
    latest: ObstacleList | None  # as it came, however old
    grid: Grid | None
    age: float  # of the latest list since it came, seconds

    @property
    def sees(self) -> bool:
        return not self.stop


class Subscription:
    """Listens in a thread of its own until close(). Use it as a context manager."""

    def __init__(self, url: str, stale_after: float, on_list: Callable[[ObstacleList], None] | None) -> None:
        try:
            self._bus = lcm.LCM(url)
        except RuntimeError as error:
            raise RuntimeError(f"LCM cannot be opened at {url}: {error}") from error
        self._stale_after, self._on_list = stale_after, on_list
        self._lock = threading.Lock()
        self._list: ObstacleList | None = None
        self._grid: Grid | None = None
        self._health: Any = None
        self._list_at = self._health_at = float("-inf")
        self.refused = 0  # messages that could not be understood
        self._closed = threading.Event()
        self._hear("SCREE_OBSTACLES", lambda data: list_of_message(decode_list(data)), self._take_list)
        self._hear("SCREE_GRID", lambda data: grid_of_message(decode_grid(data)), self._take_grid)
        self._hear("SCREE_HEALTH", decode_health, self._take_health)
        self._thread = threading.Thread(target=self._listen, name="scree", daemon=True)
        self._thread.start()

    def __enter__(self) -> Subscription:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        self._closed.set()
        self._thread.join()

    def view(self) -> View:
        now = time.monotonic()
        with self._lock:
            found, grid, age = self._list, self._grid, now - self._list_at
            stop = self._why_stop(now, age)
        return View(stop, found.in_base() if found and not stop else (), found, grid, age)

    def _why_stop(self, now: float, age: float) -> str:
        if self._health is None:
            return "no health yet"
        if now - self._health_at > HEALTH_PATIENCE:
            return "screed says nothing any more"
        if self._health.state != self._health.OK:
            return f"blind: {self._health.reason}"
        if age > self._stale_after:
            return "the lists are stale" if self._list else "no list yet"
        return ""

    def _hear(self, channel: str, decode: Callable[[bytes], Any], take: Callable[[Any], None]) -> None:
        def handle(_: str, data: bytes) -> None:
            try:
                message = decode(data)
            except (ValueError, IndexError, OverflowError, StructError):
                self.refused += 1
                return
            take(message)

        self._bus.subscribe(channel, handle)

    def _take_list(self, found: ObstacleList) -> None:
        with self._lock:
            self._list, self._list_at = found, time.monotonic()
        if self._on_list:
            self._on_list(found)

    def _take_grid(self, grid: Grid) -> None:
        with self._lock:
            self._grid = grid

    def _take_health(self, health: Any) -> None:
        with self._lock:
            self._health, self._health_at = health, time.monotonic()

    def _listen(self) -> None:
        while not self._closed.is_set():
            self._bus.handle_timeout(100)  # milliseconds


def subscribe(
    url: str = DEFAULT_URL,
    stale_after: float = 0.5,
    on_list: Callable[[ObstacleList], None] | None = None,
) -> Subscription:
    """Listens to screed. `view()` of what it gives says at any time what is there and whether to stop.

    @param url lcm.url of screed
    @param stale_after seconds without a list after which nothing may be relied on
    @param on_list called from the listening thread with each list
    """
    return Subscription(url, stale_after, on_list)
