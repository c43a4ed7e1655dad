"""scree-py: exports and imports of captures and lists."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from .read import ReadError, sentence, shown


def _export(options: argparse.Namespace) -> None:
    if not options.mcap and not options.parquet:
        options.refuse("nothing is asked for: --mcap FILE or --parquet DIR")
    common = {"scree": options.scree, "config": options.config, "force": options.force}
    if options.mcap:
        from .mcap_export import export_mcap

        lists = export_mcap(options.source, options.mcap, with_cloud=not options.no_cloud, **common)
        print(f"{shown(options.mcap)}: {lists} lists")
    if options.parquet:
        from .parquet_export import export_parquet

        rows = export_parquet(options.source, options.parquet, **common)
        print(f"{shown(options.parquet)}: " + ", ".join(f"{name} {count}" for name, count in rows.items()))


def _import(options: argparse.Namespace) -> None:
    from .bag_import import import_bag

    done = import_bag(
        options.bag,
        options.folder,
        options.packets,
        options.imu,
        options.odometry,
        options.base,
        options.model,
    )
    print(f"{shown(options.folder)}: {done.packets} packets, {done.imu} IMU messages, {done.odometry} speeds")
    for note in [*done.notes, *(f"left out: {count} {what}" for what, count in done.refused.items())]:
        print(f"scree-py: {note}", file=sys.stderr)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="scree-py", description="Scree's lists for other programs")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    export = commands.add_parser("export", help="lists, poses, clouds and health for viewers and tables")
    export.add_argument("source", type=Path, help="capture, JSON lines or LCM log")
    export.add_argument("--mcap", type=Path, metavar="FILE", help="for Foxglove, Lichtblick and Rerun")
    export.add_argument("--parquet", type=Path, metavar="DIR", help="tables lists, obstacles, tracks, health")
    export.add_argument("--no-cloud", action="store_true", help="of a capture leave out the lidar's clouds")
    export.add_argument("--config", metavar="FILE", help="configuration [that of the capture]")
    export.add_argument("--scree", metavar="PROGRAM", help="the command-line tool [scree on the path]")
    export.add_argument("--force", action="store_true", help="overwrite what is there")
    export.set_defaults(run=_export, refuse=export.error)
    bag = commands.add_parser("import", help="a capture of a ROS 1 or ROS 2 bag or MCAP file")
    bag.add_argument("bag", type=Path)
    bag.add_argument("folder", type=Path, help="of the capture")
    bag.add_argument("--packets", metavar="TOPIC", help="the lidar's raw packets [the only VelodyneScan]")
    bag.add_argument("--imu", metavar="TOPIC", help="[the only Imu]")
    bag.add_argument("--odometry", metavar="TOPIC", help="wheel odometry [the only Odometry or Twist]")
    bag.add_argument("--base", default="base_link", metavar="FRAME", help="the robot's frame [base_link]")
    bag.add_argument(
        "--model", default="vlp16", choices=["vlp16", "puck_lite", "puck_hires"], help="lidar [vlp16]"
    )
    bag.set_defaults(run=_import)
    return parser


def main(arguments: list[str] | None = None) -> int:
    options = _parser().parse_args(arguments)
    try:
        options.run(options)
    except (ReadError, OSError) as error:
        print(f"scree-py: {sentence(error)}", file=sys.stderr)
        return 1
    except ImportError as error:
        extra = {"rosbags": "bags"}.get((error.name or "").split(".")[0], "export")
        print(f'scree-py: {error.name} is missing: pip install "scree[{extra}]"', file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
