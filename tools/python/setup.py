"""Writes the types of the messages with lcm-gen when the package is built."""

import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

HERE = Path(__file__).parent
TYPES = HERE.parent.parent / "src" / "publish" / "lcm"


class BuildWithTypes(build_py):
    def run(self):
        super().run()
        folder = Path(self.build_lib) / "scree"
        generator = shutil.which("lcm-gen") or shutil.which("lcm-gen", path=str(Path(sys.executable).parent))
        if generator is None:
            raise RuntimeError("there is no lcm-gen: pip install lcm, or apt install liblcm-bin")
        written = folder / "lcm-gen"
        subprocess.run([generator, "--python", "--ppath", written, *sorted(TYPES.glob("*.lcm"))], check=True)
        for module in (written / "scree").glob("*_t.py"):
            shutil.move(module, folder / module.name)
        shutil.rmtree(written)


setup(cmdclass={"build_py": BuildWithTypes})
