"""The Python package as pip installs it: python3 python_package_test.py SCREE SOURCE [TEST ...]"""

import importlib.util
import os
import shutil
import sys

from browser import Page
from programs import ProgramTest, main

SCREE, SOURCE = sys.argv[1:3]
PACKAGE = os.path.join(SOURCE, "tools/python")


class PythonPackageTest(ProgramTest):
    def needs(self, *modules):
        for module in modules:
            if importlib.util.find_spec(module) is None:
                self.skipTest(f"there is no module {module} (tests/requirements.txt)")

    def installed(self):
        """The folder that pip installed it into, from a copy: pip leaves files where it builds."""
        self.needs("pip", "setuptools", "lcm", "pytest")
        for part in ("tools/python", "src/publish/lcm"):
            shutil.copytree(os.path.join(SOURCE, part), self.path(f"copy/{part}"))
        self.done(sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-build-isolation",
                  "--no-index", "--target", self.path("site"), self.path("copy/tools/python"))  # fmt: skip
        return self.path("site")

    def run_tests(self, name):
        site = self.installed()
        tests = os.path.join(PACKAGE, "tests")
        environment = {**os.environ, "PYTHONPATH": site, "SCREE": SCREE,
                       "PATH": f"{site}/bin:{os.environ['PATH']}", "PYTHONDONTWRITEBYTECODE": "1"}  # fmt: skip
        done = self.done(sys.executable, "-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider", f"{tests}/{name}",
                         cwd=tests, env=environment)  # fmt: skip
        print(done.stdout)
        if " skipped" in done.stdout:
            self.skipTest(done.stdout[done.stdout.index("SKIPPED") :].splitlines()[0])

    def test_records(self):
        self.run_tests("test_records.py")

    def test_subscribe(self):
        self.run_tests("test_subscribe.py")

    def test_export(self):
        self.needs("foxglove", "mcap", "pyarrow")
        self.run_tests("test_export.py")

    def test_import(self):
        self.needs("rosbags")
        self.run_tests("test_import.py")

    def test_fleet(self):
        self.needs("distributed", "pyarrow")
        self.run_tests("test_fleet.py")

    def test_the_page_of_a_fleet_in_the_browser(self):
        self.needs("distributed", "pyarrow", "playwright")
        site = self.installed()
        environment = {**os.environ, "PYTHONPATH": site}
        for seed in ("1", "2"):
            self.done(SCREE, "simulate", self.path(f"drives/drive{seed}"), "--seconds", "2", "--scene", "easy", "--seed", seed)
        os.mkdir(self.path("drives/broken"))
        self.write("drives/broken/lidar.pcap", "nothing")
        page_file = self.path("page.html")
        for arguments in (["run", self.path("drives"), "--out", self.path("out"), "--workers", "1"],
                          ["report", self.path("out"), page_file]):  # fmt: skip
            command = [sys.executable, "-m", "scree.fleet_commands", *arguments, "--scree", SCREE]
            self.done(*command, env=environment, cwd=self.folder)
        page = Page(self, f"file://{page_file}")
        self.assertIn("failed: ", page.text("tbody tr:first-child"))
        scores = "[...document.querySelectorAll('tbody tr')].map((row) => Number(row.cells[1].textContent)).filter((x) => x)"
        self.assertEqual(page.of(scores), sorted(page.of(scores)))
        for column in range(1, 10):
            page.click(f"th:nth-child({column})")
        page.click("th:nth-child(2)")  # once more: the other way round
        self.assertEqual(page.of(scores), sorted(page.of(scores), reverse=True))
        page.click("tbody a")
        page.page.wait_for_selector("#map")
        page.wait_for("document.body.dataset.ready === 'yes' && document.getElementById('figures').textContent.includes('F1')")
        self.assertEqual(page.complaints, [])

    def test_types_and_style(self):
        self.needs("mypy", "ruff", "foxglove", "rosbags")
        site = self.installed()
        self.done(sys.executable, "-m", "ruff", "check", "--no-cache", PACKAGE)
        self.done(sys.executable, "-m", "ruff", "format", "--no-cache", "--check", PACKAGE)
        done = self.done(sys.executable, "-m", "mypy", "--config-file", f"{PACKAGE}/pyproject.toml", "--cache-dir",
                         self.path("mypy"), "-p", "scree", cwd=site)  # fmt: skip
        self.assertIn("no issues", done.stdout)


if __name__ == "__main__":
    main(sys.argv[3:])
