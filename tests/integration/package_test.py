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
                       "usr/share/scree/paper.toml", "usr/share/scree/small.toml",
                       "usr/share/scree/sweep.toml"]:
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
        self.assertRegex(effective, r"\nwidth = 1\.0 +# default\n")
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
        pages = ["scree.1", "scree-spy.1", "screed.8", *(f"scree-{it}.1" for it in subcommands)]
        for name, section in (page.rsplit(".", 1) for page in pages):
            page = self.done("zcat", f"{root}/usr/share/man/man{section}/{name}.{section}.gz")
            self.assertRegex(page, rf"\.SH NAME\n{name} \\- \w", name)
            for heading in ["OPTIONS", "EXAMPLES", "FILES", '"EXIT STATUS"']:
                self.assertIn(f".SH {heading}", page, name)

    def test_every_key_stands_in_the_manual_page_of_the_configuration(self):
        root = self.unpack()
        page = self.done("zcat", f"{root}/usr/share/man/man5/scree.toml.5.gz").replace("\\-", "-")
        keys = self.done(f"{root}/usr/bin/scree", "config", "--defaults", "--all")
        for key in re.findall(r"^(\w+ = .+?) +#", keys, re.M):
            self.assertIn(f".TP\n\\fB{key}\\fP\n", page)
        self.assertEqual(self.run_to_end("man", "--warnings", "-l", "-", input=page).stderr, "")

    def test_a_planner_finds_the_package_in_cmake_and_pkg_config(self):
        root = self.unpack()
        flags = self.done("pkg-config", "--cflags", "scree",
                          env={"PKG_CONFIG_PATH": f"{root}/usr/share/pkgconfig", "PATH": os.environ["PATH"]})  # fmt: skip
        self.assertIn(f"{root}/usr", os.path.normpath(flags.split()[0][2:]))
        examples = f"{root}/usr/share/doc/scree/examples"
        self.done("cmake", "-S", examples, "-B", self.path("built"), f"-DCMAKE_PREFIX_PATH={root}/usr")
        self.done("cmake", "--build", self.path("built"))
        self.assertTrue(os.access(self.path("built/planner"), os.X_OK))

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

    def test_zsh_offers_words_and_files(self):
        root = self.unpack()
        script = (
            "compadd() { shift; print -l -- $@ }; _files() { print files };"
            'words=("${@:2}"); CURRENT=$#words; f() { source $1 }; f $1'
        )

        def offered(line):
            source = f"{root}/usr/share/zsh/vendor-completions/_scree"
            return self.done("zsh", "-f", "-c", script, "zsh", source, *line.split(" ")).split()

        self.assertIn("decode", offered("scree "))
        self.assertEqual(offered("scree decode --sensor "), ["encoder", "imu", "lidar"])
        self.assertIn("mixed", offered("scree simulate --scene "))
        self.assertIn("--out", offered("scree decode --"))
        self.assertEqual(offered("scree decode --out "), ["files"])
        self.assertEqual(offered("scree-spy --url "), ["files"])

    def test_fish_offers_words(self):
        root = self.unpack()
        source = f"{root}/usr/share/fish/vendor_completions.d/scree.fish"

        def offered(line):
            return self.done("fish", "-N", "-c", f"source {source}; complete -C '{line}'",
                             env={"HOME": self.folder, "PATH": os.environ["PATH"]}).split()  # fmt: skip

        self.assertIn("decode", offered("scree de"))
        self.assertEqual(offered("scree decode --sensor "), ["encoder", "imu", "lidar"])
        self.assertEqual(offered("scree study seed"), ["seed-distance"])
        self.assertIn("mixed", offered("scree simulate --scene "))

    def test_bash_completes_subcommands_options_and_their_words(self):
        root = self.unpack()
        overview = self.done(f"{root}/usr/bin/scree", "--help").partition("Subcommands:")[2]
        self.assertEqual(self.complete(root, "scree "), re.findall(r"^  ([a-z]+) ", overview, re.M))
        self.assertEqual(self.complete(root, "scree dec"), ["decode"])
        self.assertEqual(self.complete(root, "scree decode --se"), ["--sensor"])
        self.assertEqual(self.complete(root, "scree decode --sensor "), ["encoder", "imu", "lidar"])
        self.assertEqual(self.complete(root, "scree study seed"), ["seed-distance"])
        self.assertEqual(self.complete(root, "scree train --profile m"), ["map"])
        self.assertEqual(self.complete(root, "scree simulate --scene ro"), ["rolling", "rough"])
        self.assertEqual(self.complete(root, "scree detect "), [], "bash offers files")
        self.assertEqual(self.complete(root, "scree record --config "), [], "bash offers files")
        self.assertEqual(self.complete(root, "screed --ch"), ["--check-config"])
        self.assertEqual(self.complete(root, "scree-spy --u"), ["--url"])


if __name__ == "__main__":
    main(sys.argv[3:])
