"""The Debian package: python3 package_test.py CPACK BUILD_FOLDER [TEST ...]"""

import glob
import os
import re
import sys
import zipfile

from programs import ProgramTest, main

CPACK, BUILD = sys.argv[1:3]


class PackageTest(ProgramTest):
    def setUp(self):
        super().setUp()
        config = os.path.join(BUILD, "CPackConfig.cmake")
        self.done(CPACK, "--config", config, "-B", self.path("made"), cwd=BUILD)
        (self.package,) = glob.glob(self.path("made/*.deb"))

    def done(self, *command, **options):
        return super().done(*command, **options).stdout

    def unpack(self):
        self.done("dpkg-deb", "-x", self.package, self.path("root"))
        return self.path("root")

    def test_lintian_finds_no_error(self):
        print(self.done("lintian", "--allow-root", "--fail-on", "error", self.package))

    def test_the_configuration_is_the_users(self):
        self.done("dpkg-deb", "-e", self.package, self.path("control"))
        with open(self.path("control/conffiles")) as file:
            self.assertEqual(file.read().split(), ["/etc/scree/scree.toml"])
        etc = [line for line in self.done("dpkg-deb", "-c", self.package).splitlines()
               if "./etc/" in line and not line.endswith("/")]  # fmt: skip
        self.assertEqual(len(etc), 1, etc)

    def test_its_programs_find_its_files(self):
        root = self.unpack()
        for config in ["etc/scree/scree.toml", "usr/share/scree/cloud.toml", "usr/share/scree/map.toml",
                       "usr/share/scree/paper.toml", "usr/share/scree/sweep.toml"]:
            self.done(f"{root}/usr/bin/screed", "--check-config", "--config", f"{root}/{config}")

    def test_drop_ins_go_over_the_shipped_configuration(self):
        root = self.unpack()
        drop_in = self.path("root/etc/scree/scree.d/robot.toml")
        os.mkdir(os.path.dirname(drop_in))
        with open(drop_in, "w") as file:
            file.write("[stop]\nlength = 4.5\n")
        scree, config = f"{root}/usr/bin/scree", f"{root}/etc/scree/scree.toml"
        effective = self.done(scree, "config", "--config", config)
        self.assertRegex(effective, rf"\nlength = 4\.5 +# {drop_in}:2\n")
        self.assertRegex(effective, rf"\nwidth = 1\.0 +# {config}:\d+\n")
        self.assertRegex(self.done(scree, "config", "--defaults"), r"\nlength = 2\.0 +# default\n")
        with open(drop_in, "w") as file:
            file.write("[stop]\nlenght = 4.5\n")
        refused = self.run_to_end(scree, "config", "--config", config)
        self.assertEqual(refused.returncode, 1)
        self.assertIn(f"{drop_in}:2: stop.lenght is not a setting; the nearest is stop.length",
                      refused.stderr)  # fmt: skip

    def test_every_command_has_a_manual_page(self):
        root = self.unpack()
        overview = self.done(f"{root}/usr/bin/scree", "--help")
        subcommands = re.findall(r"^  ([a-z]+) {2,}", overview.partition("Subcommands:")[2], re.M)
        self.assertIn("detect", subcommands)
        for name in ["screed", "scree", "scree-spy", *(f"scree-{command}" for command in subcommands)]:
            page = self.done("zcat", f"{root}/usr/share/man/man1/{name}.1.gz")
            self.assertRegex(page, rf"\.SH NAME\n{name} \\- \w", name)
            self.assertIn(".SH OPTIONS", page, name)

    def test_its_messages_are_understood_in_python_and_java(self):
        root = self.unpack()
        code = (
            "import scree; found = scree.obstacle_list_t(); found.stamp_ns = 7; found.size = 1;"
            "rock = scree.obstacle_t(); rock.height = 0.5; found.obstacles = [rock];"
            "again = scree.obstacle_list_t.decode(found.encode());"
            "assert (again.stamp_ns, again.obstacles[0].height) == (7, 0.5)"
        )
        modules = f"{root}/usr/lib/python3/dist-packages"
        self.done(sys.executable, "-c", code, env={"PYTHONPATH": modules})
        with zipfile.ZipFile(f"{root}/usr/share/java/scree.jar") as jar:
            classes = {os.path.basename(name) for name in jar.namelist() if name.endswith(".class")}
        with zipfile.ZipFile(f"{root}/usr/share/java/scree-spy.jar") as jar:
            self.assertIn("scree/spy/ObstacleView.class", jar.namelist())
        types = os.listdir(f"{root}/usr/share/scree/lcm")
        self.assertEqual(classes, {name.replace(".lcm", ".class") for name in types})
        headers = os.listdir(f"{root}/usr/include/scree")
        self.assertEqual(set(headers), {name.replace(".lcm", ".hpp") for name in types})

    def complete(self, root, line):
        """What bash offers for the last word of a line."""
        words = line.split(" ")
        script = (
            'source "$0"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _scree;'
            'printf "%s\\n" "${COMPREPLY[@]}"'
        )
        completions = f"{root}/usr/share/bash-completion/completions/{words[0]}"
        return self.done("bash", "-c", script, completions, *words).split()

    def test_bash_completes_subcommands_options_and_their_words(self):
        root = self.unpack()
        overview = self.done(f"{root}/usr/bin/scree", "--help").partition("Subcommands:")[2]
        self.assertEqual(self.complete(root, "scree "), re.findall(r"^  ([a-z]+) ", overview, re.M))
        self.assertEqual(self.complete(root, "scree dec"), ["decode"])
        self.assertEqual(self.complete(root, "scree decode --se"), ["--sensor"])
        self.assertEqual(self.complete(root, "scree decode --sensor "), ["encoder", "imu", "lidar"])
        self.assertEqual(self.complete(root, "scree study seed"), ["seed-distance"])
        self.assertEqual(self.complete(root, "scree train --profile m"), ["map"])
        self.assertEqual(self.complete(root, "scree detect "), [], "bash offers files")
        self.assertEqual(self.complete(root, "scree record --config "), [], "bash offers files")
        self.assertEqual(self.complete(root, "screed --ch"), ["--check-config"])
        self.assertEqual(self.complete(root, "scree-spy --u"), ["--url"])


if __name__ == "__main__":
    main(sys.argv[3:])
