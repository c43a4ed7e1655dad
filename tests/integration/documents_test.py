"""The documents: python3 documents_test.py SOURCE BUILD_FOLDER [TEST ...]"""

import os
import sys

from lcm_sender import Sender
from programs import ProgramTest, main

SOURCE, BUILD = sys.argv[1:3]
sys.path.insert(0, os.path.join(BUILD, "tools/package/python"))
import scree  # noqa: E402

LONGEST = 159  # lines of README.md


class DocumentsTest(ProgramTest):
    def check(self):
        return self.run_to_end(os.path.join(SOURCE, "tools/lint-documents"), self.folder)

    def assert_finds(self, mistake):
        result = self.check()
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr.rstrip("\n"), mistake)

    def assert_passes(self):
        result = self.check()
        self.assertEqual((result.returncode, result.stderr), (0, ""))

    def test_readme_stays_short(self):
        self.write("README.md", "a line\n" * LONGEST)
        self.assert_passes()
        self.write("README.md", "a line\n" * (LONGEST + 1))
        self.assert_finds("README.md: it has 160 lines, and may have 159")

    def test_links_lead_somewhere(self):
        self.write("README.md", "See [part](part/README.md#two-words) and [it](https://a.org/b).\n")
        os.mkdir(self.path("part"))
        self.write("part/README.md", "# Two words\n`[a](b)`, ![up](../README.md)\n")
        self.assert_passes()
        self.write("part/README.md", "# Other words\n")
        self.assert_finds("README.md:1: README.md has no heading #two-words")
        self.write("part/README.md", "# Two words\n\n![gone](gone.png)\n")
        self.assert_finds("part/README.md:3: there is no gone.png")

    def test_the_planner_of_the_readme_works(self):
        with open(os.path.join(SOURCE, "README.md")) as file:
            code = file.read().partition("```cpp\n")[2].partition("```")[0]
        default = "udpm://239.255.76.67:7667?ttl=0"
        self.assertIn(default, code)
        source = self.write("planner.cpp", code.replace(default, self.url))
        flags = self.done("pkg-config", "--cflags", "--libs", "lcm").stdout.split()
        types = os.path.join(BUILD, "src/publish/lcmtypes")
        self.done("g++", "-Wall", "-Wextra", "-Werror", source, "-o", self.path("planner"),
                  f"-I{types}", *flags)  # fmt: skip

        rock, hole = scree.obstacle_t(), scree.obstacle_t()
        rock.kind, rock.center, rock.height = rock.POSITIVE, [4, 3, 0], 0.35
        hole.kind, hole.center, hole.height = hole.NEGATIVE, [7, -1, 0], -0.5
        found, health = scree.obstacle_list_t(), scree.health_t()
        found.size, found.obstacles = 2, [rock, hole]
        health.state, health.reason = health.BLIND, "no packets"
        planner = self.start(self.path("planner"))
        sender = Sender(self.url, {"SCREE_OBSTACLES": found, "SCREE_HEALTH": health})
        self.addCleanup(sender.stop)
        self.read_until(planner.stdout, "rock at 4.00 3.00, 0.35 m")
        self.read_until(planner.stdout, "hole at 7.00 -1.00, -0.50 m")
        self.read_until(planner.stdout, "stop: no packets")
        sender.stop()
        self.read_until(planner.stdout, "stop: screed is silent")


if __name__ == "__main__":
    main(sys.argv[3:])
