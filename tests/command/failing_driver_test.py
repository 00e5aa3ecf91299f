#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A driver that fails: each OpenGL call of a small render in turn (tests/faults/failing_egl.cpp)."""
import json
import os
import re
import subprocess
from pathlib import Path

from support import FRAGTRACE, SCENES, Case, main, run, told

STAND_IN = FRAGTRACE.parent / "failing_egl"
SOURCES = SCENES.parent / "src"
OLD = b"what was there before"


def real_egl():
    listed = subprocess.run(["/sbin/ldconfig", "-p"], capture_output=True, text=True, check=True).stdout
    return re.search(r"libEGL\.so\.1 .*=> (\S+)", listed).group(1)


class Failing(Case):
    scene = "sphere-textured"  # with a tree, textures and several lights
    options = ("--quiet",)
    samples = 2
    noisy = None  # a picture with the filter's layers, which is filtered instead

    def words(self):
        if self.noisy:
            return ["denoise", self.noisy, "-o", self.path, "--denoise", "variance", "--quiet"]
        return ["render", SCENES / f"{self.scene}.gltf", "-o", self.path, "--resolution", "16,16", "--spp", str(self.samples), *self.options]

    def drawn(self, **faults):
        """A command over a file that is there."""
        self.path = self.folder / "picture.pfm"
        self.path.write_bytes(OLD)
        settings = {f"FRAGTRACE_{name.upper()}": str(value) for name, value in faults.items()}
        paths = ":".join(filter(None, [str(STAND_IN), os.environ.get("LD_LIBRARY_PATH")]))
        return run(*self.words(), "--rendering-backend", "egl", timeout=60,
                   env={**os.environ, **settings, "LD_LIBRARY_PATH": paths, "FRAGTRACE_REAL_EGL": real_egl()})

    def calls(self, kind):
        """The names of those that can fail in this way."""
        log = self.folder / "calls"
        result = self.drawn(fail_kind=kind, fail_log=log)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.right = self.path.read_bytes()
        return log.read_text().splitlines()

    def fail_each(self, kind, step, names=None):
        """Every step-th call, of those of these names."""
        calls = self.calls(kind)
        numbers = [i for i, name in enumerate(calls, 1) if names is None or name in names][::step]
        self.assertGreater(len(numbers), 2)
        for number in numbers:
            with self.subTest(kind=kind, call=number, name=calls[number - 1]):
                self.fail_one(kind, number, calls)
        self.path.unlink()

    def fail_one(self, kind, number, calls):
        """Lets the call of that number fail, among those that can fail in this way, and checks what is left."""
        name = calls[number - 1]
        nth, log = calls[:number].count(name), self.folder / "calls"
        for _ in range(4):  # the busier a machine, the more draws a picture takes, and the more calls of some functions
            result = self.drawn(fail_kind=kind, fail_only=name, fail_call=nth, fail_log=log)
            if len(log.read_text().splitlines()) >= nth:
                break
        written = self.path.read_bytes()
        if result.returncode == 0:
            # A failure may go unseen if nothing is asked of the object afterwards.
            self.assertTrue(name.startswith("glDelete") or number == len(calls), f"{name} failed unseen")
            self.assertEqual(written, self.right)
            return
        self.assertIn(result.returncode, (1, 4), result.stderr)
        self.assertTrue(result.stderr.startswith("fragtrace: "), result.stderr)
        if kind != "build":  # the message of a failed build also prints the driver's log
            self.assertEqual(len(told(result.stderr)), 1, result.stderr)
        self.assertEqual(written, OLD)
        self.assertEqual(set(self.folder.iterdir()) - {self.folder / "calls", self.noisy}, {self.path})


class FailingDriver(Failing):
    def test_calls_that_do_nothing_are_seen(self):
        self.fail_each("memory", 31)

    def test_a_lost_context_is_seen(self):
        self.fail_each("lost", 47)

    def test_shaders_that_are_not_built_are_seen(self):
        self.fail_each("build", 1)

    def keep_noisy(self):
        """`denoise` filters where it reads, so its calls have an order; `render` has a thread for the filter."""
        noisy = self.folder / "noisy.exr"
        self.renders(SCENES / "sphere-textured.gltf", "-o", noisy, "--resolution", "16,16", "--spp", 2, "--quiet", "--aov", "denoising,samples,variance")
        self.noisy = noisy

    def test_a_filter_that_fails_is_seen(self):
        self.keep_noisy()
        self.fail_each("memory", 3, ("glNamedFramebufferTexture", "glNamedFramebufferDrawBuffers", "glUniform1i", "glUniform2i"))

    def test_programs_of_passes_are_started_before_one_is_waited_for(self):
        """So that drivers that compile in threads of their own (GL_KHR_parallel_shader_compile) do so at once."""
        self.keep_noisy()
        calls = self.calls("memory")
        asks = "".join({"glLinkProgram": "l", "glGetProgramiv": "?", "glGetShaderiv": "?"}.get(name, "") for name in calls)
        self.assertIn("llllll??????", asks)  # those of the filter
        self.assertEqual(calls.count("glMaxShaderCompilerThreadsKHR"), 1)
        self.assertLess(calls.index("glMaxShaderCompilerThreadsKHR"), calls.index("glCompileShader"))

    def test_without_a_second_context_the_filter_takes_the_first(self):
        self.options = ("--denoise", "variance", "--verbose")
        self.drawn()
        right = self.path.read_bytes()
        result = self.drawn(fail_kind="second")
        self.assertEqual((result.returncode, self.path.read_bytes()), (0, right))
        self.assertIn("the filter has no thread: no second context", result.stderr)

    def test_light_paths_that_fail_are_seen(self):
        self.scene = "caustics"
        self.fail_each("memory", 1, ("glGetInternalformativ", "glGetFloatv", "glProgramUniform4fv", "glProgramUniform2f", "glBlendFunc", "glDisable"))

    def test_without_fences_or_mapped_memory_the_picture_is_the_same(self):
        self.scene, self.samples = "cornell-box", 1024  # more than one draw takes
        self.calls("memory")
        for name in ("glFenceSync", "glClientWaitSync", "glMapNamedBufferRange"):
            result = self.drawn(fail_name=name)
            self.assertEqual((result.returncode, result.stderr), (0, ""), name)
            self.assertEqual(self.path.read_bytes(), self.right, name)

    def test_where_nothing_can_be_blended_camera_paths_bring_caustics(self):
        self.scene, self.options = "caustics", ()
        left = self.drawn(fail_kind="blend")
        self.assertEqual(left.returncode, 0, left.stderr)
        self.assertIn("warning: this driver cannot add points to 32-bit floats", left.stderr)
        drawn = self.path.read_bytes()
        self.options = ("--caustics", "off")
        self.assertNotIn("warning", self.drawn().stderr)
        self.assertEqual(drawn, self.path.read_bytes())

    def test_limits_that_are_not_true_do_no_harm(self):
        self.calls("memory")
        huge = self.drawn(fail_kind="huge")
        self.assertEqual((huge.returncode, huge.stderr, self.path.read_bytes()), (0, "", self.right))
        small = self.drawn(fail_kind="small")
        self.assertEqual(small.returncode, 1)
        self.assertRegex(small.stderr, r"\Afragtrace: .*this driver.*\n\Z")
        self.assertEqual(self.path.read_bytes(), OLD)
        self.path.unlink()

    def test_what_is_no_number_is_black_and_said(self):
        self.options = ()
        result = self.drawn(fail_kind="nan")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("warning: samples of 256 pixels were not finite and count as black", result.stderr)
        self.assertFalse(any(self.path.read_bytes()[-12 * 256:]))

    def test_a_driver_that_is_stuck_is_said(self):
        self.calls("memory")
        result = self.drawn(fail_kind="stall")
        self.assertEqual((result.returncode, self.path.read_bytes()), (0, self.right))
        self.assertEqual(result.stderr, "fragtrace: warning: the driver has not finished a draw for 10 s; it may be busy or stuck\n")

    def test_every_function_that_is_called_can_fail(self):
        called = set()
        for folder in ("gl", "render"):
            for path in (SOURCES / folder).glob("*.*"):
                called |= set(re.findall(r"\b(gl[A-Z]\w*)\(", path.read_text()))
        stand_in = Path(__file__).parent.parent / "faults/failing_egl.cpp"
        wrapped = set(re.findall(r"WRAP(?:_[A-Z]+)?\((gl\w+)\)", stand_in.read_text()))
        self.assertEqual(called - {"glGetError"}, wrapped)


class EveryFailingCall(Failing):
    def test_calls_that_do_nothing_are_seen(self):
        self.fail_each("memory", 1)

    def test_a_lost_context_is_seen(self):
        self.fail_each("lost", 1)


class GpuDriver(Case):
    """The way of GPUs (timers, two draws in flight, storage buffers), by llvmpipe under another name (tests/faults/failing_egl.cpp)."""

    def setUp(self):
        super().setUp()
        paths = ":".join(filter(None, [str(STAND_IN), os.environ.get("LD_LIBRARY_PATH")]))
        self.gpu = {**os.environ, "LD_LIBRARY_PATH": paths, "FRAGTRACE_REAL_EGL": real_egl(), "FRAGTRACE_FAIL_KIND": "gpu"}

    def render(self, name, scene, *options, env=None):
        path, stats = self.folder / f"{name}.pfm", self.folder / f"{name}.json"
        self.renders(SCENES / scene, "-o", path, "--quiet", "--rendering-backend", "egl", "--stats", stats, *options, env=env)
        return path.read_bytes(), json.loads(stats.read_text())

    def test_it_draws_the_same_bits(self):
        for scene, options in (("room-ball.gltf", ["--light-reuse", "spatial"]), ("caustics.gltf", [])):
            options = [*options, "--resolution", "70,10", "--spp", "2"]
            right, _ = self.render("software", scene, "--tune", "gpu", "--buffer-reads", "ssbo", "--schedule", "megakernel", "--dispatch", "fragment", *options)
            found, stats = self.render("gpu", scene, *options, env=self.gpu)
            self.assertEqual(stats["gl_renderer"], "a GPU that is not there")
            self.assertEqual(found, right, scene)

    def test_a_tile_of_many_draws_takes_the_time_of_its_draws(self):
        """Each wait once slept for half the time of the whole tile: 64 samples took 95 s, and did nothing."""
        options = ["--resolution", "32,32", "--spp", "64", "--schedule", "wavefront"]
        _, software = self.render("software", "cornell-box.gltf", "--tune", "gpu", *options)
        _, stats = self.render("gpu", "cornell-box.gltf", *options, env=self.gpu)
        self.assertEqual(stats["schedule"], "wavefront")
        self.assertLess(stats["render_ms"], 1000 + 10 * software["render_ms"])


if __name__ == "__main__":
    main()
