"""tools/lint-includes on trees made for it: python3 includes_test.py SOURCE [TEST ...]"""

import os
import shutil
import sys

from programs import ProgramTest, main

SOURCE = sys.argv[1]
CHECK = os.path.join(SOURCE, "tools/lint-includes")

TABLE = """
| room | holds | may use |
|---|---|---|
| `core` | points | nothing |
| `clock` | time | `core` |
| `detect` | obstacles | `core` |
| `learn` | training | `core`, `detect/network` |
| `app` | the daemon | all above except `learn` |
| `desk` | a tool | all above except `app/daemon` |

| room | not of the house |
|---|---|
| `attic` | all above |
"""
# A tree that keeps to it.
FILES = {
    "include/scree/core/points.hpp": "#include <vector>\n",
    "include/scree/clock/line.hpp": '#include "scree/core/points.hpp"\n',
    "include/scree/detect/network.hpp": '#include "scree/core/points.hpp"\n',
    "include/scree/detect/tracks.hpp": "",
    "src/detect/network.cpp": '#include "scree/detect/network.hpp"\n#include "inside.hpp"\n',
    "src/detect/inside.hpp": "",
    "include/scree/learn/training.hpp": '#include "scree/detect/network.hpp"\n',
    "include/scree/app/daemon.hpp": "",
    "include/scree/app/pipeline.hpp": '#include "scree/detect/tracks.hpp"\n',
    "src/app/main.cpp": '#include "scree/app/daemon.hpp"\n#include "scree/a_generated_t.hpp"\n',
    "tools/desk/main.cpp": '#include "scree/app/pipeline.hpp"\n#include "scree/learn/training.hpp"\n',
}


class IncludesTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.put("README.md", TABLE)
        for name, text in FILES.items():
            self.put(name, text)

    def put(self, name, text):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        self.write(name, text)

    def check(self):
        return self.run_to_end(CHECK, self.folder)

    def assert_finds(self, *lines):
        result = self.check()
        self.assertEqual(result.returncode, 1)
        found = result.stderr.splitlines()
        self.assertEqual(len(found), len(lines), found)
        for line, begin in zip(found, lines):
            self.assertEqual(line[: len(begin)], begin)

    def test_a_tree_in_order_passes(self):
        result = self.check()
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))

    def test_an_arrow_up_is_named_with_file_and_line(self):
        self.put("include/scree/core/points.hpp", '#pragma once\n\n#include "scree/clock/line.hpp"\n')
        self.assert_finds("include/scree/core/points.hpp:3: core -> clock")

    def test_an_arrow_to_a_room_beside_is_found_in_a_source_too(self):
        for include in ['#include "scree/clock/line.hpp"', "# include <scree/clock/line.hpp>  // why"]:
            self.put("src/detect/network.cpp", include + "\n")
            self.assert_finds("src/detect/network.cpp:1: detect -> clock")

    def test_of_a_room_only_the_named_header_may_be_used(self):
        self.put("include/scree/learn/training.hpp", '#include "scree/detect/tracks.hpp"\n')
        self.assert_finds("include/scree/learn/training.hpp:1: learn -> detect")

    def test_what_all_above_leaves_out_may_not_be_used(self):
        self.put("src/app/main.cpp", '#include "scree/learn/training.hpp"\n')
        self.put("tools/desk/main.cpp", '#include "scree/app/daemon.hpp"\n')
        self.assert_finds("src/app/main.cpp:1: app -> learn", "tools/desk/main.cpp:1: desk -> app")

    def test_headers_beside_the_sources_are_of_the_room(self):
        self.put("src/app/main.cpp", '#include "detect/inside.hpp"\n')
        self.put("include/scree/core/points.hpp", '#include "detect/inside.hpp"\n')
        self.assert_finds("include/scree/core/points.hpp:1: core -> detect")

    def test_code_outside_the_rooms_is_found(self):
        self.put("src/shed/rake.cpp", "")
        self.assert_finds("src/shed/rake.cpp: it is in no room")

    def test_a_room_without_code_is_found(self):
        shutil.rmtree(self.path("include/scree/clock"))
        self.assert_finds("README.md: room clock has no code")

    def test_a_room_may_only_use_rooms_above_it(self):
        self.put("README.md", TABLE.replace("| points | nothing |", "| points | `detect` |"))
        self.assert_finds("README.md: room core names detect")

    def test_a_rule_that_says_nothing_is_refused(self):
        self.put("README.md", TABLE.replace("| points | nothing |", "| points | this and that |"))
        self.assert_finds('README.md: room core may use "this and that"')

    def test_without_a_table_it_fails(self):
        self.put("README.md", "# Scree\n")
        self.assert_finds("README.md: there is no table")

    def test_an_arrow_put_into_the_real_tree_is_found(self):
        shutil.rmtree(self.folder)
        for name in ["include", "src", "drivers", "tools"]:
            shutil.copytree(os.path.join(SOURCE, name), self.path(name))
        shutil.copy(os.path.join(SOURCE, "README.md"), self.folder)
        self.test_a_tree_in_order_passes()
        with open(self.path("include/scree/core/pose.hpp"), "a") as file:
            file.write('#include "scree/detect/detector.hpp"\n')
        with open(self.path("include/scree/core/pose.hpp")) as file:
            line = len(file.readlines())
        self.assert_finds(f"include/scree/core/pose.hpp:{line}: core -> detect")


if __name__ == "__main__":
    main(sys.argv[2:])
