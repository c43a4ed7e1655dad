"""The documents: python3 documents_test.py SOURCE [TEST ...]"""

import os
import sys

from programs import ProgramTest, main

SOURCE = sys.argv[1]
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


if __name__ == "__main__":
    main(sys.argv[2:])
