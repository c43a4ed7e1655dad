"""The Python package as pip installs it: python3 python_package_test.py SCREE SOURCE [TEST ...]"""

import importlib.util
import os
import shutil
import sys

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
