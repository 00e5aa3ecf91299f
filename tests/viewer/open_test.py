#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Files that are opened and saved: by the desktop's dialog (a portal of the tests' own), by the list in the window, and those shown before."""
import json
import shutil
import signal
import time
import unittest
from urllib.parse import quote

from support import SCENES, Case, main, read_png

try:
    from fake_portal import CANCELLED, CHOSEN, ENDED, Bus, Portal
except ImportError as error:
    Bus, WHY_NOT = None, f"{error} (Debian: python3-jeepney)"
else:
    WHY_NOT = "" if shutil.which("dbus-daemon") else "dbus-daemon is not installed"

FEW = ["--resolution", "320,240", "--spp", "2"]
NAME = "a b%20 \u00e9\u4e2d.gltf"


def uri(path):
    return "file://" + quote(str(path))


class Open(Case):
    def list_of(self, viewer, key="ctrl+o"):
        if key:
            viewer.key(key)
        return viewer.until(lambda s: s["dialog"] == "list" and s["focus"] == "text", "the list")

    def no_dialog(self, viewer):
        return viewer.until(lambda s: not s["dialog"], "no dialog")

    @unittest.skipIf(WHY_NOT, WHY_NOT)
    def test_the_desktops_dialog(self):
        bus = Bus()
        self.addCleanup(bus.close)
        portal = Portal(bus)
        model = self.folder / NAME
        shutil.copy(SCENES / "furnace.gltf", model)
        viewer = self.view(None, *FEW, wait=False, environment={**self.screen.environment, "DBUS_SESSION_BUS_ADDRESS": bus.address})
        viewer.window()
        viewer.until(lambda s: "Open..." in s.get("places", {}), "the welcome")
        time.sleep(0.3)  # until it has its size

        portal.answers = [(CHOSEN, uri(model))]
        viewer.click("Open...")
        viewer.rest(lambda s: s["scene"] == str(model), "the model")
        member, parent, _, options = portal.calls.pop()
        self.assertEqual((member, parent), ("OpenFile", f"x11:{viewer.id:x}"))
        self.assertEqual(options["current_folder"], ("ay", str(self.folder).encode() + b"\0"))
        kind, filters = options["filters"]
        self.assertEqual((kind, filters[1]), ("a(sa(us))", ("Scenes (.gltf, .glb)", [(0, "*.[gG][lL][tT][fF]"), (0, "*.[gG][lL][bB]")])))

        for answer, said in (((CHOSEN, "smb://host/a.glb"), "smb://host/a.glb is not a file of this computer"), ((CANCELLED,), None)):
            portal.answers = [answer]
            viewer.key("ctrl+o")
            if said:
                viewer.until(lambda s: said in s["messages"], said)
            viewer.wait(lambda: portal.calls, 10, "asked")
            status = self.no_dialog(viewer)
            self.assertEqual((status["scene"], status["error"]), (str(model), ""))
            portal.calls.clear()

        # If the desktop shows no dialog, or none that is seen, the list appears.
        for answer, said in (("error", "it is broken"), ((ENDED,), "its dialog has ended"), ("silent", ""), (None, "")):
            portal.answers = [answer]
            viewer.key("ctrl+o")
            if answer is None:
                viewer.wait(lambda: portal.calls, 10, "asked")
                viewer.key("ctrl+o")
            self.list_of(viewer, None)
            self.assertTrue(any(said in m for m in viewer.status()["messages"]), said)
            viewer.key("Escape")
            self.no_dialog(viewer)
            if answer is None:
                viewer.wait(lambda: portal.calls[-1][0] == "Close", 10, "the dialog that was given up is closed")
            portal.calls.clear()

        picture = self.folder / "a picture.png"
        portal.answers = [(CHOSEN, uri(picture)), None]
        viewer.key("ctrl+s")
        viewer.until(lambda s: f"wrote {picture}" in s["messages"], "the picture")
        self.assertEqual(portal.calls[0][0], "SaveFile")
        self.assertEqual(portal.calls[0][3]["current_name"], ("s", model.stem + "-1.png"))
        self.assertEqual(read_png(picture)[:2], (320, 240))
        viewer.key("ctrl+o")
        viewer.wait(lambda: len(portal.calls) == 2, 10, "asked")
        viewer.until(lambda s: s["dialog"] == "desktop", "it is waited for")
        self.ends_well(viewer, viewer.close())

    @unittest.skipIf(WHY_NOT, WHY_NOT)
    def test_a_tip_and_the_list_appear_in_one_frame(self):
        """Dear ImGui 1.86 ends the program where a window appears after a modal one in the latter's first frame."""
        bus = Bus()
        self.addCleanup(bus.close)
        portal = Portal(bus)
        viewer = self.view("furnace", *FEW, environment={**self.screen.environment, "DBUS_SESSION_BUS_ADDRESS": bus.address})
        viewer.key("Tab")
        row = viewer.until(lambda s: s["places"].get("Denoise"), "the panel")["places"]["Denoise"]
        for _ in range(4):
            portal.answers = ["silent"]
            viewer.at(10, 10)
            viewer.key("ctrl+o")
            viewer.until(lambda s: s["dialog"] == "desktop", "it is waited for")
            viewer.process.send_signal(signal.SIGSTOP)
            viewer.at(round(row[0] + row[2] / 2), round(row[1] + row[3] / 2))
            viewer.key("ctrl+o")
            viewer.process.send_signal(signal.SIGCONT)
            self.list_of(viewer, None)
            viewer.key("Escape")
            self.no_dialog(viewer)
        self.ends_well(viewer, viewer.close())

    def test_the_list_and_files_shown_before(self):
        models = self.folder / "models"
        (models / "deep").mkdir(parents=True)
        for name in ("part 10.gltf", "Part 9.gltf", NAME):
            shutil.copy(SCENES / "furnace.gltf", models / name)
        shutil.copy(SCENES / "sky.pfm", models)
        (models / "notes.txt").write_text("")
        remembered = self.folder / "state/fragtrace/viewer.json"
        remembered.parent.mkdir(parents=True)
        remembered.write_text(json.dumps({"recent": [str(models / "gone.gltf"), str(models / "Part 9.gltf")], "bookmarks": {}}))
        viewer = self.view(None, *FEW, wait=False)
        viewer.window()
        viewer.click("recent 0")  # grey
        time.sleep(0.2)
        self.assertEqual((viewer.status()["state"], viewer.status()["error"]), ("empty", ""))
        viewer.click("recent 1")
        viewer.rest(lambda s: s["scene"].endswith("Part 9.gltf"), "the file shown before")

        status = self.list_of(viewer)
        rows = sorted((place[1], name) for name, place in status["places"].items() if name.startswith("file ") and (models / name[5:]).exists())
        self.assertEqual([name[5:] for _, name in rows], ["deep", NAME, "Part 9.gltf", "part 10.gltf", "sky.pfm"])
        viewer.key("Down", "Return")
        viewer.until(lambda s: "file deep" not in s["places"], "the folder is entered")
        viewer.key("BackSpace")
        viewer.until(lambda s: "file deep" in s["places"], "the folder above")
        viewer.xdotool("type", "B%20")
        viewer.until(lambda s: "file deep" not in s["places"] and "file " + NAME in s["places"], "found")
        viewer.key("Return")
        viewer.rest(lambda s: s["scene"].endswith(NAME), "the model")
        self.list_of(viewer)
        viewer.click("file sky.pfm")
        viewer.click("file accept")
        viewer.rest(lambda s: s["environment"].endswith("sky.pfm"), "the environment")

        old = self.folder / "old.png"
        old.write_text("old")
        self.list_of(viewer, "ctrl+s")
        viewer.xdotool("type", "old")
        time.sleep(0.2)
        viewer.key("Return")
        time.sleep(0.2)
        self.assertEqual((viewer.status()["dialog"], old.read_text()), ("list", "old"))
        viewer.key("Return")
        viewer.until(lambda s: f"wrote {old}" in s["messages"], "replaced")
        self.assertEqual(read_png(old)[:2], (320, 240))
        self.list_of(viewer, "ctrl+s")
        viewer.keys_at_once(*"mypic", "Return")
        viewer.until(lambda s: f"wrote {self.folder / 'mypic.png'}" in s["messages"], "under the whole name")
        self.ends_well(viewer, viewer.close())


if __name__ == "__main__":
    main()
