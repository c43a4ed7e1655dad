"""scree-fleet: many captures at once, and one page of them."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from .read import ReadError, sentence, shown

LONGEST = 1_000_000  # seconds; the system's own limit is twice that


def _run(options: argparse.Namespace) -> int:
    from .fleet import captures_in, version_of
    from .fleet_run import run

    if options.config and not options.config.is_file():
        raise ReadError(f"there is no configuration {options.config}")
    captures = captures_in(options.captures)
    if not captures:
        raise ReadError(f"there is no capture below {options.captures}")
    version_of(options.scree)  # better to fail here than in each of them
    rows = run(
        captures,
        options.out,
        options.scheduler,
        options.workers,
        scree=options.scree,
        config=options.config,
        timeout=options.timeout,
        retry_failed=options.retry_failed,
    )
    failed = [row for row in rows if not row["ok"]]
    stored = sum(bool(row["was_stored"]) for row in rows)
    print(
        f"{shown(options.out)}: {len(rows)} captures, {stored} of them done before or of the same content, "
        f"{len(failed)} failed"
    )
    for row in failed[:10]:
        print(shown(f"scree-fleet: {row['capture']}: {row['reason']}"), file=sys.stderr)
    return 1 if len(failed) == len(rows) else 0


def _report(options: argparse.Namespace) -> int:
    from .fleet_report import write_report

    if options.page.exists() and not options.force:
        raise ReadError(f"{options.page} is there already: --force overwrites it")
    count = write_report(options.out, options.page, options.against, options.worst, options.scree)
    print(f"{shown(options.page)}: with the reports of {count} drives")
    return 0


def whole_number(text: str) -> int:
    if (count := int(text)) < 1:
        raise argparse.ArgumentTypeError(f"{text} is below 1")
    return count


def seconds(text: str) -> float:
    if not 0 < (value := float(text)) <= LONGEST:
        raise argparse.ArgumentTypeError(f"{text} is not above 0 and at most {LONGEST}")
    return value


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="scree-fleet", description="Drives by the thousand")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    run = commands.add_parser("run", help="look at many captures; what was done before is not done again")
    run.add_argument(
        "captures", type=Path, help="folder with captures below it, text file with a path a line, or .pcap"
    )
    run.add_argument(
        "--out", type=Path, required=True, metavar="DIR", help="for results and tables; all workers see it"
    )
    run.add_argument(
        "--scheduler", metavar="ADDRESS", help="of Dask, as tcp://host:8786 [a cluster on this computer]"
    )
    run.add_argument(
        "--workers", type=whole_number, metavar="N", help="of the cluster on this computer [a core each]"
    )
    run.add_argument("--config", type=Path, metavar="FILE", help="configuration [that of each capture]")
    run.add_argument("--scree", metavar="PROGRAM", help="the command-line tool [scree on the path]")
    run.add_argument(
        "--timeout", type=seconds, default=3600, metavar="SECONDS", help="for a program on a capture [3600]"
    )
    run.add_argument("--retry-failed", action="store_true", help="look again at what failed before")
    run.set_defaults(run=_run)
    report = commands.add_parser("report", help="one page of a run, the worst drives first")
    report.add_argument("out", type=Path, help="folder of the run")
    report.add_argument("page", type=Path, help="page to write")
    report.add_argument(
        "--against", type=Path, metavar="DIR", help="folder of another run: what became better and worse"
    )
    report.add_argument(
        "--worst", type=whole_number, default=20, metavar="N", help="drives that get their own report [20]"
    )
    report.add_argument("--scree", metavar="PROGRAM", help="the command-line tool [that of the run]")
    report.add_argument("--force", action="store_true", help="overwrite the page")
    report.set_defaults(run=_report)
    return parser


def main(arguments: list[str] | None = None) -> int:
    options = _parser().parse_args(arguments)
    try:
        code: int = options.run(options)
        return code
    except (ReadError, OSError) as error:
        print(f"scree-fleet: {sentence(error)}", file=sys.stderr)
    except ImportError as error:
        print(f'scree-fleet: {error.name} is missing: pip install "scree[fleet]"', file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
