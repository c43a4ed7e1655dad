"""Runs `scree.fleet.process` over many captures on Dask."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Any

from distributed import Client, LocalCluster, as_completed

from .fleet import Row, process, sweep_up
from .fleet_tables import write_tables
from .read import ReadError


class Progress:
    """A line on a terminal: how far it is, and how long it still takes."""

    WIDTH = 30

    def __init__(self, total: int) -> None:
        self.total, self.done, self.failed, self.stored = total, 0, 0, 0
        self.begin = time.monotonic()
        self.is_shown = sys.stderr.isatty()

    def see(self, row: Row) -> None:
        self.done += 1
        self.failed += not row["ok"]
        self.stored += bool(row["was_stored"])
        if not self.is_shown:
            return
        left = (time.monotonic() - self.begin) / self.done * (self.total - self.done)
        bar = "#" * (self.WIDTH * self.done // self.total)
        print(
            f"\r[{bar:{self.WIDTH}}] {self.done} of {self.total}, {self.failed} failed, {left:.0f} s left  ",
            end="\n" if self.done == self.total else "",
            file=sys.stderr,
            flush=True,
        )


def run(
    captures: list[str],
    out: str | Path,
    scheduler: str | None = None,
    workers: int | None = None,
    client: Client | None = None,
    **options: Any,
) -> list[Row]:
    """Processes all captures and writes the tables. A row for each, in their order.

    @param scheduler address of a running one; without it and without a client, a cluster on this computer
    @param options for `process`
    """
    Path(out).mkdir(parents=True, exist_ok=True)
    sweep_up(out)
    if client is not None:
        return _run(client, captures, out, options)
    if scheduler is not None:
        try:
            connected = Client(scheduler)
        except Exception as error:  # of what it throws, some has no common kind
            raise ReadError(f"the scheduler {scheduler} cannot be reached: {error}") from error
        with connected:
            return _run(connected, captures, out, options)
    with (
        LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) as cluster,
        Client(cluster) as local,
    ):
        return _run(local, captures, out, options)


def _run(client: Client, captures: list[str], out: str | Path, options: dict[str, Any]) -> list[Row]:
    progress = Progress(len(captures))
    futures = client.map(process, captures, out=str(Path(out).resolve()), pure=False, **options)
    numbers = {future.key: number for number, future in enumerate(futures)}
    rows: list[Row | None] = [None] * len(captures)
    for future in as_completed(futures):
        number = numbers[future.key]
        try:
            row: Row = future.result()
        except Exception as error:  # it took its worker with it, again and again
            row = {
                "capture": captures[number],
                "key": "",
                "ok": False,
                "reason": f"{type(error).__name__}: {error}",
                "was_stored": False,
            }
        rows[number] = row
        progress.see(row)
    done = [row for row in rows if row is not None]
    write_tables(out, done)
    return done
