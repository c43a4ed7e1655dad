"""The examples against a replay: python3 examples_test.py SCREED SCREE SOURCE BUILD_FOLDER [TEST ...]"""

import os
import sys

from lcm_sender import Sender
from live_daemon import Lines, LiveDaemonTest
from live_sensors import Player
from programs import PATIENCE, main

LiveDaemonTest.screed, LiveDaemonTest.scree = sys.argv[1:3]
SOURCE, BUILD = sys.argv[3:5]
PYTHON_TYPES = os.path.join(BUILD, "tools/package/python")
sys.path.insert(0, PYTHON_TYPES)
import scree  # noqa: E402


class ExamplesTest(LiveDaemonTest):
    def planners(self):
        """What each example says, line by line."""
        flags = self.done("pkg-config", "--cflags", "--libs", "lcm").stdout.split()
        types = os.path.join(BUILD, "src/publish/lcmtypes")
        self.done("g++", "-std=c++17", "-Wall", "-Wextra", "-Werror", f"{SOURCE}/tools/examples/planner.cpp",
                  "-o", self.path("planner"), f"-I{types}", *flags)  # fmt: skip
        commands = {"C++": [self.path("planner"), self.url]}
        try:
            import lcm  # noqa: F401

            commands["Python"] = [sys.executable, f"{SOURCE}/tools/examples/planner.py", self.url]
        except ImportError:
            print("the example in Python was not run: there is no module lcm")
        environment = {**os.environ, "PYTHONPATH": PYTHON_TYPES}
        return {
            name: Lines(self.start(*command, env=environment).stdout)
            for name, command in commands.items()
        }

    def test_planners_drive_and_stop_in_a_replay(self):
        capture = self.simulate()
        os.remove(os.path.join(capture, "can.log"))
        planners = self.planners()
        for planner in planners.values():
            planner.first(lambda line: line == "stop: no health yet\n")
        self.start_daemon()
        self.assertTrue(self.mti.measures.wait(PATIENCE))
        player = Player(capture, self.port, self.position_port, self.mti)
        self.addCleanup(player.stop)
        seen = {}
        for name, planner in planners.items():
            seen[name] = planner.first(lambda line: line.startswith("drive"))[1]
        player.wait()
        player.stop()
        for name, planner in planners.items():
            line, _ = planner.first(lambda line: line.startswith("stop: blind: "), seen[name])
            print(f"{name}: {line.strip()}")

    def test_planners_see_where_things_go_and_what_is_stale(self):
        planners = self.planners()
        walker, found, health = scree.obstacle_t(), scree.obstacle_list_t(), scree.health_t()
        health.state = health.OK
        # The robot is at 10 5 and looks along y: ahead of it is the walker in half a second.
        found.p, found.q = [10, 5, 0], [0.5**0.5, 0, 0, 0.5**0.5]
        walker.kind, walker.center, walker.velocity = walker.POSITIVE, [8.9, 7, 0], [2, 0]
        found.size, found.obstacles = 1, [walker]
        grid = scree.grid_t()
        grid.p, grid.q, grid.origin, grid.cell_size = found.p, found.q, [9, 5], 0.5
        grid.columns, grid.rows, grid.cells = 4, 6, 24
        grid.state, grid.ground = bytes([grid.FREE] * 24), [0] * 24
        messages = {"SCREE_HEALTH": health, "SCREE_GRID": grid, "SCREE_OBSTACLES": found}
        sender = Sender(self.url, messages)
        self.addCleanup(sender.stop)
        at = {}

        def say(words):
            for name, planner in planners.items():
                at[name] = planner.first(lambda line: words in line, at.get(name, 0))[1] + 1

        say("stop: a rock")
        walker.velocity = [0, 0]
        say("drive\n")
        grid.state = bytes([grid.UNKNOWN] * 24)
        say("drive slowly")
        walker.center, walker.kind = [10, 7, 0], walker.NEGATIVE
        say("stop: a hole")
        # A kerb that reaches into the way, while its middle lies beside it.
        walker.center, walker.extent, walker.kind = [13, 7, 0], [3, 0.3, 0.2], walker.POSITIVE
        say("drive slowly")
        walker.center = [11.2, 7, 0]
        say("stop: a rock")
        sender.messages = {"SCREE_HEALTH": health, "SCREE_GRID": grid}
        say("stop: the lists are stale")
        health.state, health.reason = health.BLIND, "no packets"
        say("stop: blind: no packets")


if __name__ == "__main__":
    main(sys.argv[5:])
