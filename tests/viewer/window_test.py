#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The window's life: opening, size, minimising, files dropped and changed, errors, ends."""
import json
import os
import select
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

from support import FRAGTRACE, SCENES, Case, Screen, Viewer, main, pixels_of, wait_for
from xdnd import drop

SIZE = ["--resolution", "320,240"]
FEW = [*SIZE, "--spp", "2"]


def listener_at(listener, number):
    """Listens as the X server of that number; false where there is one."""
    try:
        listener.bind(f"\0/tmp/.X11-unix/X{number}")
        listener.listen()
        return True
    except OSError:
        return False


class Ends(Case):
    def test_escape_and_the_close_button_end_with_0(self):
        viewer = self.view("furnace", *FEW)
        viewer.at(160, 120)
        viewer.xdotool("click", 1)
        viewer.until(lambda s: s["selected"], "selected")
        viewer.key("Escape")
        status = viewer.rest(lambda s: s["selected"] is None and s["pick"] is None, "nothing is selected")
        ask = "press Escape again to quit"
        self.assertNotIn(ask, status["messages"])
        viewer.at(140, 120)
        viewer.process.send_signal(signal.SIGSTOP)
        viewer.xdotool("click", 1)
        viewer.key("Escape")
        viewer.process.send_signal(signal.SIGCONT)  # the answer comes after Escape
        time.sleep(0.5)
        status = viewer.rest()
        self.assertIsNone(status["pick"])
        self.assertNotIn(ask, status["messages"])
        viewer.at(2, 2)
        viewer.xdotool("click", 1)
        status = viewer.until(lambda s: "nothing is there" in s["messages"], "said for a while")
        self.assertIsNone(status["pick"])
        viewer.key("Escape")
        viewer.until(lambda s: ask in s["messages"], "the question")
        viewer.key("j", "j", "Escape")  # another key has taken it back
        time.sleep(0.5)
        self.assertIsNone(viewer.process.poll())
        viewer.key("Escape")
        self.ends_well(viewer, viewer.end())
        viewer = self.view("furnace", *FEW)
        self.ends_well(viewer, viewer.close())

    def test_a_file_alone_is_viewed_and_a_command_stays_one(self):
        status = self.folder / "status.json"
        process = subprocess.Popen([FRAGTRACE, SCENES / "furnace.gltf", *FEW, "--status-file", status], env=self.screen.environment)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        for _ in range(600):
            if status.exists() and json.loads(status.read_text())["state"] == "resting":
                break
            time.sleep(0.1)
        self.assertEqual(json.loads(status.read_text())["state"], "resting")
        (self.folder / "info").write_text("{}")
        viewing = subprocess.Popen([FRAGTRACE, "./info", "--status-file", status], cwd=self.folder, env=self.screen.environment)
        self.addCleanup(viewing.wait)
        self.addCleanup(viewing.kill)
        wait_for(lambda: "info: " in json.loads(status.read_text())["error"], 60, "the file is viewed")
        for words, says in ((["info"], "file is required"), (["nothing"], "'nothing' is no command of fragtrace, and no file: render"),
                            (["view", SCENES / "furnace.gltf", "--stats", "s.json"], "--stats is no option of view")):
            result = subprocess.run([FRAGTRACE, *words], capture_output=True, text=True, cwd=self.folder, env=self.screen.environment, timeout=60)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(says, result.stderr)

    def test_without_a_display_it_is_4_and_says_so(self):
        environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
        for name in (None, ":987"):
            if name:
                environment["DISPLAY"] = name
            status = self.folder / "status.json"
            result = subprocess.run([FRAGTRACE, "view", SCENES / "furnace.gltf", "--status-file", status], env=environment,
                                    capture_output=True, text=True, timeout=60)
            self.assertIn("no window", json.loads(status.read_text())["error"])
            self.assertEqual(result.returncode, 4, result.stderr)
            self.assertIn("no window", result.stderr)
            self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)

    def test_without_libgl_it_is_4_and_names_the_packages(self):
        (self.folder / "libGL.so.1").write_text("no library")
        result = subprocess.run([FRAGTRACE, "view", SCENES / "furnace.gltf"], capture_output=True, text=True, timeout=60,
                                env={**self.screen.environment, "LD_LIBRARY_PATH": str(self.folder)})
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertRegex(result.stderr, r"^fragtrace: no window: .*libGL\.so\.1: .*libgl1.*\n$")

    def test_signals_and_the_end_of_the_display_are_told_in_one_line(self):
        # A desktop that ends sends both signals.
        for signals in ((signal.SIGTERM,), (signal.SIGTERM, signal.SIGHUP)):
            viewer = self.view("furnace", *FEW)
            for number in signals:
                viewer.process.send_signal(number)
            # A message names the light.
            self.assertEqual((viewer.end(), viewer.stderr().count("\n"), viewer.status()["state"]), (130, 1, "closed"))
            viewer.status_file.unlink()
        screen = Screen()
        for process in (screen.server, screen.manager):
            self.addCleanup(process.wait)
            self.addCleanup(process.kill)
        self.addCleanup(screen.folder.cleanup)
        viewer = Viewer(screen, self.folder, "furnace", *FEW)
        screen.display.close()
        screen.server.kill()
        self.assertEqual(viewer.end(), 4)
        self.assertEqual(viewer.stderr().splitlines()[1:], ["fragtrace: the display is gone"])
        self.assertEqual((viewer.status()["state"], viewer.status()["error"]), ("failed", "the display is gone"))
        viewer.errors.close()

    def test_a_display_that_ends_while_the_window_opens_is_4_and_said(self):
        for requests in (1000, 4000, 12000):
            viewer = self.view("furnace", *FEW, wait=False, environment={**self.screen.environment, "DISPLAY": self.display_for(requests)})
            self.assertEqual(viewer.end(60), 4, viewer.stderr())
            self.assertEqual(viewer.stderr(), "fragtrace: the display is gone\n")
            self.assertEqual(viewer.status()["error"], "the display is gone")
            viewer.status_file.unlink()

    def display_for(self, most):
        """The name of a display that ends once the program has sent so many bytes."""
        listener = socket.socket(socket.AF_UNIX)
        self.addCleanup(listener.close)
        number = next(n for n in range(500 + os.getpid() % 1000, 10000) if listener_at(listener, n))

        def serve():
            program, _ = listener.accept()
            with program, socket.socket(socket.AF_UNIX) as server:
                server.connect(f"\0/tmp/.X11-unix/X{self.screen.name[1:]}")
                left = most
                while left > 0:
                    for side in select.select([program, server], [], [])[0]:
                        data = side.recv(65536)
                        left -= len(data) if side is program else 0
                        (server if side is program else program).sendall(data)
        threading.Thread(target=serve, daemon=True).start()
        return f":{number}"

    def test_profilers_tell_its_threads_apart(self):
        viewer = self.view("furnace", *FEW)
        # The driver's threads have the names of those that made them, or their own.
        process = Path("/proc", str(viewer.process.pid))
        self.assertIn("trace", {path.read_text().strip() for path in process.glob("task/*/comm")})
        self.assertEqual((process / "comm").read_text().strip(), "fragtrace")
        self.ends_well(viewer, viewer.close())

    def test_vectors_of_512_bits_are_left_out(self):
        viewer = self.view("furnace", *FEW, "--vector-width", "512")
        self.assertIn("--vector-width 512 is left out", viewer.stderr())
        self.ends_well(viewer, viewer.close())

    def test_a_scene_that_cannot_be_read_is_3(self):
        viewer = self.view(self.folder / "none.gltf", *FEW, wait=False)
        self.assertEqual(viewer.end(60), 3)
        self.assertIn("none.gltf", viewer.stderr())
        self.assertEqual(viewer.status()["state"], "failed")
        self.assertIn("none.gltf", viewer.status()["error"])

    def test_a_file_that_is_no_scene_is_said_in_the_window_which_takes_another(self):
        broken = self.folder / "broken.gltf"
        broken.write_text("{")
        viewer = self.view(broken, *FEW, wait=False)
        viewer.window()
        status = viewer.until(lambda s: s.get("error"), "the error")
        self.assertEqual(status["state"], "empty")
        self.assertIn("broken.gltf", status["error"])
        viewer.until(lambda s: "error" in s["places"], "the error is shown")
        viewer.key("Escape")
        viewer.until(lambda s: "error" not in s["places"], "it is closed")
        self.assertEqual(self.title(viewer), "fragtrace")
        self.assertEqual(viewer.close(), 3)
        self.assertIn("broken.gltf", viewer.stderr())
        viewer = self.view(broken, *FEW, wait=False)
        viewer.window()
        viewer.until(lambda s: s.get("error"), "the error")
        shutil.copy(SCENES / "furnace.gltf", broken)
        viewer.key("Up")
        viewer.rest(lambda s: s["scene"].endswith("broken.gltf") and not s["error"], "the mended scene")
        self.assertEqual(self.title(viewer), "fragtrace: broken.gltf")
        drop(self.screen, viewer.id, SCENES / "sphere-plane.gltf")
        viewer.rest(lambda s: s["scene"].endswith("sphere-plane.gltf") and not s["error"], "the other scene")
        self.ends_well(viewer, viewer.close())

    def title(self, viewer):
        return self.screen.call("xdotool", "getwindowname", viewer.id).strip()

    def test_what_cannot_be_is_2(self):
        for options in (["--spp", "0"], ["--nonsense"], ["-o", "x.png"], ["--camera-index", "7"],
                        ["--resolution", "60000,60000"]):
            result = subprocess.run([FRAGTRACE, "view", SCENES / "furnace.gltf", *options], capture_output=True, text=True, timeout=60,
                                    env=self.screen.environment)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertTrue(result.stderr.startswith("fragtrace: "), result.stderr)


class Sizes(Case):
    def test_resizing_draws_at_the_new_size_and_minimising_draws_nothing(self):
        viewer = self.view("furnace", *FEW)
        viewer.xdotool("windowsize", "--sync", viewer.id, 400, 200)
        status = viewer.rest(lambda s: (s["width"], s["height"]) == (400, 148), "resized")
        self.assertEqual((status["sides"][0]["width"], status["sides"][0]["height"]), (400, 148))
        shown = viewer.press_for_file("F12", ".png")
        self.same(pixels_of(shown), pixels_of(self.render("furnace", "--resolution", "400,148", "--spp", 2)))

        viewer.xdotool("windowminimize", "--sync", viewer.id)
        time.sleep(0.3)
        status = viewer.rest()
        self.assertEqual((status["width"], status["height"]), (400, 148))
        viewer.xdotool("windowmap", "--sync", viewer.id)
        viewer.xdotool("windowactivate", "--sync", viewer.id)
        time.sleep(0.3)
        viewer.rest()
        self.assertGreater(len(set(viewer.grab()[2])), 1)
        self.ends_well(viewer, viewer.close())


class Empty(Case):
    def test_a_window_without_a_scene_takes_one_and_remembers_it(self):
        viewer = self.view(None, *FEW, wait=False)
        viewer.window()
        status = viewer.until(lambda s: s["state"] == "empty" and "welcome" in s["places"], "the welcome")
        self.assertNotIn("recent 0", status["places"])
        for key in ("f", "c", "F12", "ctrl+c", "ctrl+v", "ctrl+z", "space", "Up", "u", "F2", "b", "v"):
            viewer.key(key)
        self.assertFalse(viewer.status()["split"])
        drop(self.screen, viewer.id, SCENES / "sky.pfm")
        viewer.until(lambda s: any("sky.pfm" in m for m in s["messages"]), "an environment waits")
        for name in ("sphere-plane", "furnace"):
            drop(self.screen, viewer.id, SCENES / (name + ".gltf"))
            viewer.rest(lambda s: s["scene"].endswith(name + ".gltf"), name)
        status = viewer.rest()
        self.assertNotIn("welcome", status["places"])
        self.assertTrue(status["environment"].endswith("sky.pfm"))
        self.ends_well(viewer, viewer.close())
        viewer = self.view(None, *FEW, wait=False)
        viewer.window()
        viewer.click("recent 1")
        viewer.rest(lambda s: s["scene"] == str(SCENES / "sphere-plane.gltf"), "the file shown before")
        self.ends_well(viewer, viewer.close())

    def test_a_broken_environment_keeps_no_model_from_being_shown(self):
        broken = self.folder / "broken.pfm"
        broken.write_bytes(b"PF\n64 32\n-1.0\n")
        viewer = self.view(None, *FEW, wait=False)
        viewer.window()
        viewer.until(lambda s: s["state"] == "empty", "the welcome")
        drop(self.screen, viewer.id, broken)
        viewer.until(lambda s: any("will light" in m for m in s["messages"]), "an environment waits")
        drop(self.screen, viewer.id, SCENES / "furnace.gltf")
        viewer.until(lambda s: any("is left out" in m for m in s["messages"]) and "broken.pfm" in s["error"], "it is told")
        drop(self.screen, viewer.id, SCENES / "furnace.gltf")
        self.assertEqual(viewer.rest(lambda s: s["scene"].endswith("furnace.gltf"), "a model")["environment"], "")
        self.ends_well(viewer, viewer.close())

    def test_an_environment_after_a_broken_model_waits_for_the_next(self):
        broken = self.folder / "broken.gltf"
        broken.write_text("{")
        viewer = self.view(None, *FEW, wait=False)
        viewer.window()
        viewer.until(lambda s: s["state"] == "empty", "the welcome")
        drop(self.screen, viewer.id, broken)
        viewer.until(lambda s: "broken.gltf" in s["error"], "an error")
        drop(self.screen, viewer.id, SCENES / "sky.pfm")
        viewer.until(lambda s: any("sky.pfm will light" in m for m in s["messages"]), "an environment waits")
        drop(self.screen, viewer.id, SCENES / "furnace.gltf")
        self.assertTrue(viewer.rest(lambda s: s["scene"].endswith("furnace.gltf"), "a model")["environment"].endswith("sky.pfm"))
        self.ends_well(viewer, viewer.close())

    def test_what_is_remembered_and_cannot_be_read_is_said_and_stays(self):
        file = self.folder / "state/fragtrace/viewer.json"
        file.parent.mkdir(parents=True)
        file.write_text("{")
        viewer = self.view("furnace", *FEW)
        viewer.until(lambda s: any("viewer.json" in m for m in s["messages"]), "said")
        self.ends_well(viewer, viewer.close())
        self.assertEqual(file.read_text(), "{")


class Files(Case):
    def test_dropped_scenes_and_environments_are_loaded(self):
        viewer = self.view("furnace", *FEW)
        drop(self.screen, viewer.id, SCENES / "sphere-plane.gltf")
        viewer.rest(lambda s: s["scene"].endswith("sphere-plane.gltf"), "dropped scene")
        shown = viewer.press_for_file("F12", ".png")
        self.same(pixels_of(shown), pixels_of(self.render("sphere-plane", *SIZE, "--spp", 2)))
        drop(self.screen, viewer.id, SCENES / "sky.pfm")
        viewer.rest(lambda s: s["environment"].endswith("sky.pfm"), "dropped environment")
        shown = viewer.press_for_file("F12", ".png")
        rendered = self.render("sphere-plane", *SIZE, "--spp", 2, "--hdri-file", SCENES / "sky.pfm")
        self.same(pixels_of(shown), pixels_of(rendered))
        drop(self.screen, viewer.id, SCENES / "README.md")
        viewer.until(lambda s: any("README.md" in m for m in s["messages"]), "refused")
        self.ends_well(viewer, viewer.close())

    def test_changed_files_are_read_again_and_errors_keep_the_last_good(self):
        scene = self.folder / "scene.gltf"
        shutil.copy(SCENES / "furnace.gltf", scene)
        shaders = self.folder / "shaders"
        shutil.copytree(SCENES.parent / "shaders", shaders)
        viewer = self.view(scene, *FEW, "--watch", "--shader-folder", shaders)
        shown = pixels_of(viewer.press_for_file("F12", ".png"))

        text = (shaders / "trace.glsl").read_text()
        (shaders / "trace.glsl").write_text(text + "\nthis is no GLSL\n")
        status = viewer.until(lambda s: s["error"], "error of the shader")
        self.assertIn("trace.glsl", status["error"])
        viewer.rest()
        self.same(pixels_of(viewer.press_for_file("F12", ".png")), shown)
        (shaders / "trace.glsl").write_text(text)
        viewer.rest(lambda s: not s["error"], "repaired shader")

        scene.write_text("{")
        status = viewer.until(lambda s: s["error"], "error of the scene")
        self.assertIn("scene.gltf", status["error"])
        for stage in ("F3", "F3"):  # another program says nothing of the file
            asked = viewer.status()["asked"]
            viewer.key(stage)
            self.assertIn("scene.gltf", viewer.rest(lambda s: s["asked"] > asked)["error"])
        scene.unlink()
        viewer.until(lambda s: "cannot be opened" in s["error"], "it is gone")
        asked = viewer.status()["asked"]
        shutil.copy(SCENES / "sphere-phong.gltf", scene)
        # The error is gone a moment before the new scene is drawn.
        viewer.rest(lambda s: not s["error"] and s["asked"] > asked, "repaired scene")
        # A new scene of the same name keeps its options, and so its picture is that of `render`.
        self.same(pixels_of(viewer.press_for_file("F12", ".png")), pixels_of(self.render(scene, *SIZE, "--spp", 2)))
        exr = viewer.press_for_file("shift+F12", ".exr")
        self.assertGreater(exr.stat().st_size, 1000)
        self.ends_well(viewer, viewer.close())


if __name__ == "__main__":
    main()
