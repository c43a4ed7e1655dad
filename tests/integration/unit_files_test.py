"""What systemd thinks of our unit: python3 unit_files_test.py SCREED FOLDER [TEST ...]"""

import os
import sys

from programs import ProgramTest, main

SCREED, FOLDER = sys.argv[1:3]
UNIT = os.path.join(FOLDER, "screed.service")


class UnitFilesTest(ProgramTest):
    def test_the_sandbox_is_tight(self):
        result = self.run_to_end(
            "systemd-analyze", "security", "--offline=true", "--threshold=22", "--no-pager", UNIT
        )
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn("Overall exposure level", result.stdout)

    def test_systemd_has_nothing_to_complain_of(self):
        """Its exit status is 0 for an unknown key too; it prints it."""
        with open(UNIT) as file:
            text = file.read()
        self.assertIn("/usr/bin/screed", text)
        unit = self.write("screed.service", text.replace("/usr/bin/screed", SCREED))
        result = self.run_to_end("systemd-analyze", "verify", "--man=no", unit)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))


if __name__ == "__main__":
    main(sys.argv[3:])
