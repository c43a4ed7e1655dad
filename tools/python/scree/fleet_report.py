"""One page of a run: the worst drives first, and what another version did better and worse."""

from __future__ import annotations

import os
from dataclasses import dataclass
from html import escape
from importlib.resources import files
from math import inf
from pathlib import Path
from typing import Any
from urllib.parse import quote

import pyarrow.parquet as pq

from .fleet import Row, setting_of
from .read import ReadError, run_scree

CHANGE = 0.005  # of F1: below it nothing has changed


@dataclass
class Comparison:
    better: list[tuple[Row, Row]]  # before, now
    worse: list[tuple[Row, Row]]
    same: int
    only_one: int  # drives that only one of the runs has, or has a score of


def rows_of(out: str | Path) -> list[Row]:
    file = Path(out) / "captures.parquet"
    if not file.exists():
        raise ReadError(f"{out} has no run of scree-fleet: there is no captures.parquet")
    rows: list[Row] = pq.read_table(file).to_pylist()
    return rows


def is_scored(row: Row) -> bool:
    """Whether it has a score that counts: one of too small a part of the drive does not."""
    return row["ok"] and row["f1"] is not None and row["counts"] is not False


def badness(row: Row) -> tuple[bool, bool, float, float]:
    """Sorts the worst first."""
    f1 = row["f1"] if is_scored(row) else inf
    return bool(row["ok"]), row["counts"] is not False, f1, -(row["blind"] or 0.0)


def compare(before: list[Row], now: list[Row]) -> Comparison:
    """Drives of the same content; the change of F1, the largest first."""
    old = {row["content"]: row for row in before if is_scored(row)}
    pairs = [(old[row["content"]], row) for row in now if is_scored(row) and row["content"] in old]
    change = {id(pair): pair[1]["f1"] - pair[0]["f1"] for pair in pairs}
    better = sorted((pair for pair in pairs if change[id(pair)] > CHANGE), key=lambda pair: -change[id(pair)])
    worse = sorted((pair for pair in pairs if change[id(pair)] < -CHANGE), key=lambda pair: change[id(pair)])
    drives = {row["content"] or row["capture"] for row in (*before, *now)}
    only_one = len(drives - {row["content"] for _, row in pairs})
    return Comparison(better, worse, len(pairs) - len(better) - len(worse), only_one)


def total_f1(rows: list[Row]) -> float | None:
    """Of all lists of all drives with a score that counts, as `scree evaluate` sums them."""
    rows = [row for row in rows if is_scored(row)]
    right, false, missed = (
        sum(row[name] or 0 for row in rows)
        for name in ("true_positives", "false_positives", "false_negatives")
    )
    return 2 * right / (2 * right + false + missed) if right + false + missed else None


def write_report(
    out: str | Path,
    page: str | Path,
    against: str | Path | None = None,
    worst: int = 20,
    scree: str | None = None,
) -> int:
    """Writes the page, and the worst drives' own reports into a folder beside it. How many those are."""
    rows = sorted(rows_of(out), key=badness)
    page = Path(page)
    links = _own_reports([row for row in rows if row["ok"]][:worst], page, scree)
    versions = sorted({row["version"] for row in rows if row["version"]})
    parts = {
        "about": escape(f"Scree {', '.join(versions) or 'of no version'}"),
        "figures": _figures(rows),
        "histogram": _histogram([row["f1"] for row in rows if is_scored(row)]),
        "comparison": _comparison(compare(rows_of(against), rows), rows_of(against), rows) if against else "",
        "drives": _drives(rows, links),
    }
    text = files("scree").joinpath("fleet_page.html").read_text(encoding="utf-8")
    for name, part in parts.items():
        text = text.replace("{{" + name + "}}", part)
    page.write_text(text, encoding="utf-8")
    return len(links)


def _own_reports(rows: list[Row], page: Path, scree: str | None) -> dict[str, str]:
    """The report of each drive, by key: its path from the page.

    There is none where the capture or the configuration of the run is not there any more.
    """
    folder = page.with_name(f"{page.stem}_drives")
    links = {}
    for row in rows:
        capture = Path(row["capture"])
        report = folder / f"{row['key']}.html"
        if not report.exists():
            if not capture.exists():
                continue
            folder.mkdir(parents=True, exist_ok=True)
            config = row.get("config")
            options = ["--config", config] if config else []
            options += ["--truth"] if row["has_truth"] else []
            try:
                if config and setting_of(config) != row["setting"]:
                    continue
                run_scree(scree or row.get("program"), "report", capture, "--out", report, *options)
            except (ReadError, OSError):
                continue
        links[row["key"]] = os.path.relpath(report, page.parent)
    return links


def _shown(value: Any, digits: int = 3) -> str:
    return "–" if value is None else f"{value:.{digits}f}" if isinstance(value, float) else str(value)


def _figures(rows: list[Row]) -> str:
    done = [row for row in rows if row["ok"]]
    hours, way = sum(row["seconds"] for row in done) / 3600, sum(row["way"] for row in done) / 1000
    figures = {
        "drives": str(len(rows)),
        "failed": str(len(rows) - len(done)),
        "driven": f"{hours:.2f} h, {way:.2f} km",
        "F1 of all lists": _shown(total_f1(done)),
        "without lists": f"{sum(row['blind'] for row in done):.1f} s",
        "computed": f"{sum(row['seconds_taken'] or 0.0 for row in done) / 3600:.2f} h",
    }
    return "".join(f"<div><b>{escape(value)}</b>{escape(name)}</div>" for name, value in figures.items())


def _histogram(scores: list[float]) -> str:
    """How many drives have which F1."""
    if not scores:
        return ""
    counts = [0] * 20
    for score in scores:
        counts[min(19, int(score * 20))] += 1
    most, bars = max(counts), []
    for i, count in enumerate(counts):
        high, x = 110 * count / most, 40 + 44 * i
        bars.append(f'<rect x="{x}" y="{130 - high:.1f}" width="40" height="{high:.1f}" fill="#0072b2"/>')
        if count:
            bars.append(f'<text x="{x + 20}" y="{125 - high:.1f}" text-anchor="middle">{count}</text>')
    marks = "".join(
        f'<text x="{38 + 44 * i}" y="148" text-anchor="middle">{i / 20:g}</text>' for i in range(0, 21, 2)
    )
    return f'<h2>Drives by F1</h2><svg viewBox="0 0 960 155" width="100%" role="img">{"".join(bars)}{marks}</svg>'


def _table(columns: list[str], rows: list[str]) -> str:
    head = "".join(f"<th>{escape(column)}</th>" for column in columns)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(rows)}</tbody></table>"


def _cell(text: str, value: float | None = None, name: str = "") -> str:
    sort = f' data-value="{value}"' if value is not None else ""
    return f'<td{sort} class="{name}">{text}</td>' if name else f"<td{sort}>{text}</td>"


def _drives(rows: list[Row], links: dict[str, str]) -> str:
    lines = []
    for row in rows:
        name = escape("/".join(Path(row["capture"]).parts[-2:]))
        if link := links.get(row["key"]):
            name = f'<a href="{quote(os.fsencode(link))}">{name}</a>'
        if not row["ok"]:
            words = f'<td class="words" colspan="8">failed: {escape(row["reason"])}</td>'
            lines.append(f'<tr class="failed"><td title="{escape(row["capture"])}">{name}</td>{words}</tr>')
            continue
        if row["counts"] is False:
            name += f"<br>covers {int(100 * (row['coverage'] or 0))} % of the drive: does not count"
        scores = (row[score] if is_scored(row) else None for score in ("f1", "precision", "recall"))
        numbers = [
            *map(_shown, scores),
            row["lists"],
            row["obstacles"],
            _shown(row["way"], 1),
            _shown(row["blind"], 1),
            row["packets_lost"],
        ]
        cells = "".join(_cell(str(number)) for number in numbers)
        lines.append(f'<tr><td title="{escape(row["capture"])}">{name}</td>{cells}</tr>')
    columns = [
        "drive",
        "F1",
        "precision",
        "recall",
        "lists",
        "obstacles",
        "way m",
        "without lists s",
        "packets lost",
    ]
    return _table(columns, lines)


def _comparison(compared: Comparison, before: list[Row], now: list[Row]) -> str:
    old, new = total_f1([row for row in before if row["ok"]]), total_f1([row for row in now if row["ok"]])
    versions = ", ".join(sorted({row["version"] for row in before if row["version"]}))
    text = (
        f"<h2>Against another run</h2><p>F1 of all lists was {_shown(old)} with {escape(versions)} and is "
        f"{_shown(new)}. Better: {len(compared.better)} drives, worse: {len(compared.worse)}, the same: "
        f"{compared.same}. Only in one of both, or without a score: {compared.only_one}.</p>"
    )
    lines = []
    for word, pairs in (("worse", compared.worse), ("better", compared.better)):
        for was, row in pairs:
            change = row["f1"] - was["f1"]
            name = escape("/".join(Path(row["capture"]).parts[-2:]))
            cells = (
                _cell(_shown(was["f1"])) + _cell(_shown(row["f1"])) + _cell(f"{change:+.3f}", change, word)
            )
            counts = "".join(
                _cell(f"{row[count] - was[count]:+d}", row[count] - was[count])
                for count in ("true_positives", "false_positives", "false_negatives")
            )
            lines.append(f"<tr><td>{name}</td>{cells}{counts}</tr>")
    columns = ["drive", "F1 before", "F1 now", "change", "right", "invented", "missed"]
    return text + (_table(columns, lines) if lines else "")
