#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`cmake --install` gives a program that runs from anywhere; docs/options.md and options-bench.md, man pages, completion and the schema of --config are what `help --json` says."""
import configparser
import contextlib
import ctypes
import gzip
import json
import os
import re
import shlex
import shutil
import struct
import subprocess
import sys
import time
import unittest
import xml.etree.ElementTree
from pathlib import Path

from support import FRAGTRACE, SCENES, Case, main, read_png, run

BUILD = FRAGTRACE.parent
SCRIPTS = SCENES.parent / "scripts"
sys.path.insert(0, str(SCRIPTS))
from option_table import Table  # noqa: E402


class Installed(Case):
    def test_it_draws_the_same_from_another_folder(self):
        prefix = self.folder / "usr"
        subprocess.run(["cmake", "--install", BUILD, "--prefix", prefix], check=True, capture_output=True)
        away = self.folder / "away"
        away.mkdir()
        options = [SCENES / "coverage.gltf", "--resolution", "16,16", "--spp", "1", "--quiet", "-o"]
        environment = {**os.environ, "PATH": f"{prefix}/bin:{os.environ['PATH']}"}
        subprocess.run(["fragtrace", "render", *options, "x.png"], cwd=away, env=environment, check=True)
        subprocess.run([FRAGTRACE, "render", *options, away / "y.png"], check=True)
        self.assertEqual((away / "x.png").read_bytes(), (away / "y.png").read_bytes())

    def test_its_folders_are_below_destdir(self):
        environment = {**os.environ, "DESTDIR": str(self.folder / "stage")}
        subprocess.run(["cmake", "--install", BUILD, "--prefix", "/usr"], check=True, capture_output=True, env=environment)
        program = self.folder / "stage/usr/bin/fragtrace"
        self.assertTrue(program.is_symlink())
        self.assertTrue(program.resolve().is_relative_to((self.folder / "stage").resolve()))
        version = subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout
        self.assertRegex(version, r"^fragtrace \d+\.\d+\.\d+( \([0-9a-f]+(-dirty)?\))?\n$")


def glb(path, document, data):
    """Writes a .glb, whose buffer 0 is `data`."""
    text = json.dumps({**document, "buffers": [{"byteLength": len(data)}]}).encode()
    text += b" " * (-len(text) % 4)
    path.write_bytes(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A) + text
                     + struct.pack("<I4s", len(data), b"BIN\0") + data)


# The system calls that GNOME's host of thumbnailers refuses them.
REFUSED = ("syslog", "personality", "acct", "modify_ldt", "quotactl", "add_key", "keyctl", "request_key", "move_pages", "mbind", "get_mempolicy",
           "set_mempolicy", "migrate_pages", "unshare", "mount", "pivot_root", "perf_event_open", "ptrace")


def refusal():
    """An open file with the seccomp filter that refuses these calls."""
    library, file = ctypes.CDLL("libseccomp.so.2"), os.memfd_create("filter")
    library.seccomp_init.restype = ctypes.c_void_p
    rules = ctypes.c_void_p(library.seccomp_init(0x7FFF0000))  # SCMP_ACT_ALLOW
    for name in REFUSED:
        assert library.seccomp_rule_add(rules, 0x00050001, library.seccomp_syscall_resolve_name(name.encode()), 0) == 0, name  # EPERM
    assert library.seccomp_export_bpf(rules, file) == 0
    os.lseek(file, 0, os.SEEK_SET)
    return file


class InSandbox(Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        if not shutil.which("bwrap") or subprocess.run(["bwrap", "--unshare-all", "--ro-bind", "/", "/", "true"], check=False, capture_output=True).returncode:
            raise unittest.SkipTest("no bubblewrap that works (apt-get install bubblewrap)")


class Containers(InSandbox):
    @unittest.skipIf(len(os.sched_getaffinity(0)) < 2, "one processor has nothing to limit")
    def test_a_limit_of_processors_limits_threads(self):
        """As of `podman run --cpus`, on either version of control groups."""
        for files, threads in (({"cpu.max": "90000 100000"}, 1), ({"cpu.max": "max 100000"}, 2), ({"cpu/cpu.cfs_quota_us": "100000", "cpu/cpu.cfs_period_us": "100000"}, 1),
                               ({"cpu/cpu.cfs_quota_us": "-1", "cpu/cpu.cfs_period_us": "100000"}, 2)):
            group = self.folder / "group"
            shutil.rmtree(group, ignore_errors=True)
            (group / "cpu").mkdir(parents=True)
            for name, text in files.items():
                (group / name).write_text(text + "\n")
            words = ["bwrap", "--dev-bind", "/", "/", "--bind", group, "/sys/fs/cgroup", "taskset", "--cpu-list", ",".join(map(str, sorted(os.sched_getaffinity(0))[:2])),
                     FRAGTRACE, "render", SCENES / "coverage.gltf", "-o", "/dev/null", "--format", "pfm", "--resolution", "512,512", "--spp", "4", "--rendering-backend", "egl", "--quiet"]
            drawing = set()
            with subprocess.Popen(words, env={name: value for name, value in os.environ.items() if name != "LP_NUM_THREADS"}) as process:
                while process.poll() is None:
                    with contextlib.suppress(OSError):
                        child = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().strip()
                        drawing |= {name.parent for name in Path(f"/proc/{child}/task").glob("*/comm") if name.read_text().startswith("llvmpipe")}
                    time.sleep(0.02)
            self.assertEqual((process.returncode, len(drawing)), (0, threads), files)


class Thumbnails(InSandbox):
    """A host of thumbnailers as GNOME's (gnome-desktop): bubblewrap, where only /usr and the file are, and the seccomp filter above."""

    def setUp(self):
        super().setUp()
        self.prefix = self.folder / "usr"
        subprocess.run(["cmake", "--install", BUILD, "--prefix", self.prefix], check=True, capture_output=True)

    def thumbnail(self, file, limit=300):
        """Runs the thumbnailer of the desktop's files, which takes at most so many seconds, and returns the files that it leaves and its seconds."""
        entry = configparser.RawConfigParser()
        entry.read(self.prefix / "share/thumbnailers/fragtrace.thumbnailer")
        words = entry["Thumbnailer Entry"]["Exec"]
        self.assertIn("KILL 9 ", words)
        words = words.replace("KILL 9 ", f"KILL {limit} ")
        for sign, value in (("%i", f"/tmp/input{file.suffix}"), ("%o", "/tmp/gnome-desktop-thumbnailer.png"), ("%s", "256")):
            words = words.replace(sign, value)
        out = self.folder / f"out-{file.name}"
        out.mkdir()
        links = [word for name in ("bin", "lib", "lib64", "sbin") if os.path.islink(f"/{name}") for word in ("--symlink", f"/usr/{name}", f"/{name}")]
        rules = refusal()
        began = time.monotonic()
        subprocess.run(["bwrap", "--ro-bind", "/usr", "/usr", "--ro-bind", "/etc/ld.so.cache", "/etc/ld.so.cache", *links, "--proc", "/proc", "--dev", "/dev",
                        "--chdir", "/", "--unshare-all", "--die-with-parent", "--ro-bind", self.prefix, "/opt/fragtrace", "--bind", out, "/tmp",
                        "--ro-bind", file, f"/tmp/input{file.suffix}", "--seccomp", str(rules), *shlex.split(words)],
                       env={"PATH": "/opt/fragtrace/bin:/usr/bin", "HOME": "/home/nobody"}, pass_fds=[rules], check=False)
        took = time.monotonic() - began
        os.close(rules)
        (out / f"input{file.suffix}").unlink(missing_ok=True)  # the place for the file
        return list(out.iterdir()), took

    def test_a_model_has_a_picture_and_leaves_nothing_else(self):
        seen = {}
        for name in ("coverage", "rough-metals"):
            source = json.loads((SCENES / f"{name}.gltf").read_text())
            self.assertTrue(source["buffers"][0]["uri"].startswith("data:"), name)
            (file,), _ = self.thumbnail(SCENES / f"{name}.gltf")
            width, height, rows, step = read_png(file)
            self.assertEqual((width, height, step), (256, 256, 4))
            seen[name] = b"".join(bytes(row) for row in rows)
            self.assertGreater(len(set(seen[name])), 64)
        self.assertNotEqual(*seen.values())

    def test_a_file_of_200_mb_has_one_in_10_seconds_or_none(self):
        count = 5_000_000
        corners = b"".join(struct.pack("<9f", *(x + dx if i % 3 != 1 else y + dx for i, dx in enumerate((0, 0, 0, 1, 0, 0, 0, 1, 0))))
                           for y in range(100) for x in range(100))
        data = (corners * (count * 12 // len(corners) + 1))[:count // 3 * 36]
        data += struct.pack("<I", 0) * (200_000_000 // 4 - len(data) // 4)
        vertices = len(data) // 12 // 3 * 3
        glb(self.folder / "large.glb", {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "bufferViews": [{"buffer": 0, "byteLength": len(data)}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": vertices, "min": [0, 0, 0], "max": [100, 100, 100]}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]}, data)
        files, took = self.thumbnail(self.folder / "large.glb", limit=9)
        self.assertLess(took, 10.5)
        self.assertTrue(files or took > 8.5, took)
        for file in files:
            self.assertEqual(read_png(file)[:2], (256, 256))

    def test_what_the_desktop_reads_is_as_it_should_be(self):
        share = self.prefix / "share"
        entry = configparser.RawConfigParser()
        entry.read(share / "applications/fragtrace.desktop")
        self.assertNotIn("NoDisplay", entry["Desktop Entry"])
        about = xml.etree.ElementTree.parse(share / "metainfo/fragtrace.metainfo.xml").getroot()
        self.assertEqual(about.findtext("launchable"), "fragtrace.desktop")
        self.assertEqual({kind.text for kind in about.iter("mediatype")}, set(entry["Desktop Entry"]["MimeType"].strip(";").split(";")))
        if shutil.which("appstreamcli"):
            subprocess.run(["appstreamcli", "validate", "--no-net", share / "metainfo/fragtrace.metainfo.xml"], check=True, capture_output=True)


class Release(Case):
    def test_a_version_that_the_files_do_not_have_is_refused(self):
        version = run("--version").stdout.split()[1]
        for wrong, says in (("9.9.9", "CMakeLists.txt"), ("0", "CMakeLists.txt"), (version, "")):
            refused = subprocess.run([SCRIPTS / "release", wrong, "nothing"], capture_output=True, text=True, check=False)
            self.assertEqual((refused.returncode, refused.stdout), (1, ""))
            self.assertRegex(refused.stderr, f"^release: {says}")
        self.assertRegex((SCENES.parent / "CITATION.cff").read_text(), r"\ncff-version: 1\.2\.0\n(.*\n)*version: \d+\.\d+\.\d+\ndate-released: \d{4}-\d\d-\d\d\n")


class OptionReference(Case):
    def test_it_is_what_the_help_says(self):
        result = subprocess.run([SCRIPTS / "option_reference", "--check", FRAGTRACE], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)


class HelpFiles(Case):
    """The files that scripts/help_files writes."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.table = Table(FRAGTRACE)

    def written(self):
        subprocess.run([SCRIPTS / "help_files", FRAGTRACE, self.folder], check=True)
        return self.folder

    def completed(self, script, *words):
        """Returns the words that bash offers for the last word, in a folder with some files."""
        place = self.folder / "place"
        place.mkdir(exist_ok=True)
        for name in ("a scene.glb", "b.gltf", "c.png", "notes.txt"):
            (place / name).touch()
        (place / "folder").mkdir(exist_ok=True)
        # Bash makes a word of its own of each sign of equality.
        words = [part for word in words for part in re.findall(r"=|[^=]+|^$", word)]
        line = (f"source {shlex.quote(str(script))}; COMP_WORDS=({shlex.join(words)}); COMP_CWORD={len(words) - 1}; _fragtrace; "
                'printf "%s\\n" "${COMPREPLY[@]}"')
        result = subprocess.run(["bash", "--norc", "-c", line], cwd=place, check=True, capture_output=True, text=True)
        self.assertEqual(result.stderr, "")
        return result.stdout.split("\n")[:-1]

    def test_bash_completes_commands_options_values_and_files(self):
        script = self.written() / "completions/fragtrace"
        for words, expected in (
                (["ren"], ["render"]),
                (["bench", "sta"], ["start"]),
                (["render", "x.gltf", "--trav"], ["--traversal"]),
                (["render", "--traversal", "f"], ["front-to-back"]),
                (["render", "--traversal=f"], ["front-to-back"]),
                (["render", "--disable", "sobol,wat"], ["sobol,watertight"]),
                (["denoise", "--denoise", ""], ["auto", "variance", "oidn"]),
                (["bench", "start", "--format", "e"], ["exr"]),
                (["render", ""], ["folder", "a scene.glb", "b.gltf"]),
                (["render", "b.gltf", "-o", ""], ["folder", "c.png"]),
                (["diff", "n"], ["notes.txt"]),
                (["render", "b.gltf", "--shader-folder", ""], ["folder"]),
                (["render", "b.gltf", "--spp", ""], [""]),
                (["render", "b.gltf", "--quiet", "b"], ["b.gltf"])):
            self.assertEqual(sorted(self.completed(script, "fragtrace", *words)), sorted(expected), words)

    def test_each_option_is_offered(self):
        script = self.written() / "completions/fragtrace"
        for command in self.table.commands:
            offered = self.completed(script, "fragtrace", *command["name"].split(), "--")
            self.assertEqual(offered, [form for option in self.table.of(command["name"]) for form in option["forms"] if form.startswith("--")])

    def test_the_names_of_values_are_those_that_the_program_knows(self):
        named = {f"--{option['name']}": option for option in self.table.of("render") if option["choices"] and not option["other_values"]}
        self.assertGreater(len(named), 12)
        for option, entry in named.items():
            refusal = run("render", "x.gltf", "-o", "x.exr", option, "nonsense").stderr
            known = re.search(r"'nonsense' is none of (.*)\n", refusal)
            self.assertTrue(known, option + refusal)
            self.assertEqual(entry["choices"], known[1].split(", "), option)

    def test_what_names_a_file_says_so(self):
        for option in self.table.options:
            if re.search(r"\bfile\b|folder of|\.(exr|gltf)\b", option["text"]) and option["type"] == "text" and option["metavariable"] in ("TEXT", "NAME"):
                self.assertTrue("--output" in option["text"] or option["text"].startswith("name or index"), option["name"])

    def test_defaults_stand_in_the_page(self):
        page = gzip.decompress((self.written() / "man/fragtrace-render.1.gz").read_bytes()).decode()
        for default in ("default gi", "default 24", "default auto"):
            self.assertTrue(default in page, default)
        self.assertGreater(page.count("default "), 30)

    def test_each_command_has_a_page_with_all_options(self):
        folder = self.written() / "man"
        self.assertEqual(len(list(folder.iterdir())), len(self.table.commands))
        for command in self.table.commands:
            words = ["fragtrace", *command["name"].split()]
            page = gzip.decompress((folder / ("-".join(words) + ".1.gz")).read_bytes()).decode()
            self.assertIn(".SH NAME\n" + "\\-".join(words), page)
            for option in self.table.of(command["name"]):
                self.assertIn(option["forms"][-1].replace("-", "\\-"), page)

    def test_zsh_and_fish_take_their_files_and_offer_options(self):
        folder = self.written() / "completions"
        if shutil.which("zsh"):
            subprocess.run(["zsh", "-n", folder / "_fragtrace"], check=True)
        if shutil.which("fish"):
            line = f"source {shlex.quote(str(folder / 'fragtrace.fish'))}; complete -C "
            for words, word in (("fragtrace ren", "render"), ("fragtrace render --trav", "--traversal"), ("fragtrace render --traversal fro", "front-to-back"),
                                ("fragtrace bench sta", "start"), ("fragtrace bench start --star", "--starts")):
                offered = subprocess.run(["fish", "--no-config", "-c", line + shlex.quote(words)], check=True, capture_output=True, text=True).stdout
                self.assertEqual([one.split("\t")[0] for one in offered.splitlines()], [word], words)
        for name in ("_fragtrace", "fragtrace.fish"):
            text = (folder / name).read_text()
            for option in self.table.options:
                if option["forms"]:
                    self.assertTrue(f"{option['forms'][-1]}[" in text or f"-l {option['name']} " in text, (name, option["name"]))

    def test_the_schema_takes_what_the_program_takes(self):
        schema = json.loads((self.written() / "config.schema.json").read_text())
        members = schema["properties"]
        self.assertEqual({f"--{name}" for name in members if name != "$schema"},
                         {f"--{option['name']}" for option in [*self.table.of("render"), *self.table.of("view")]} - {"--help", "--config"})
        self.assertEqual(members["fit"]["type"], "boolean")
        self.assertEqual((members["exposure"]["minimum"], members["exposure"]["maximum"]), (-100, 100))
        self.assertEqual(members["traversal"]["enum"][0], "auto")
        config = self.folder / "c.json"
        config.write_text(json.dumps({"$schema": "config.schema.json", "exposure": 1, "resolution": [8, 8], "spp": 1, "traversal": "auto", "fit": True}))
        self.renders(SCENES / "coverage.gltf", "-o", self.folder / "x.png", "--config", config)


if __name__ == "__main__":
    main()
