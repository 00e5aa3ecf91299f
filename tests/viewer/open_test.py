#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Files that are opened and saved: by the desktop's dialog (a portal of the tests' own), without one, and those shown before."""
import json
import shutil
import time
import unittest
from urllib.parse import quote

from support import SCENES, Case, main, read_png

try:
    from fake_portal import CANCELLED, CHOSEN, ENDED, WHY_NOT, portal_for
except ImportError as error:
    WHY_NOT = f"{error} (Debian: python3-jeepney)"

FEW = ["--resolution", "320,240", "--spp", "2"]
NAME = "a b%20 \u00e9\u4e2d.gltf"


def uri(path):
    return "file://" + quote(str(path))


class Open(Case):
    def no_dialog(self, viewer):
        return viewer.until(lambda s: not s["dialog"], "no dialog")

    @unittest.skipIf(WHY_NOT, WHY_NOT)
    def test_the_desktops_dialog(self):
        portal, environment = portal_for(self)
        model = self.folder / NAME
        shutil.copy(SCENES / "furnace.gltf", model)
        viewer = self.view(None, *FEW, wait=False, environment=environment)
        viewer.window()

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

        # If the desktop shows no dialog, the user is told why, and what to do. If it shows one that is not seen, the key gives it up for another one.
        for answer, said in (("error", "it is broken"), ((ENDED,), "its dialog has ended"), ("silent", "no dialog for files: "), (None, "")):
            portal.answers = [answer]
            viewer.key("ctrl+o")
            if answer is None:
                viewer.wait(lambda: portal.calls, 10, "asked")
                portal.answers = [(CANCELLED,)]
                viewer.key("ctrl+o")
                viewer.wait(lambda: sorted(call[0] for call in portal.calls) == ["Close", "OpenFile", "OpenFile"], 10, "the dialog that was given up is closed")
            else:
                viewer.until(lambda s: any(said in m and "drop a file here" in m for m in s["messages"]), said)
            self.no_dialog(viewer)
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

    def test_files_shown_before_and_without_a_dialog(self):
        models = self.folder / "models"
        models.mkdir()
        shutil.copy(SCENES / "furnace.gltf", models / NAME)
        remembered = self.folder / "state/fragtrace/viewer.json"
        remembered.parent.mkdir(parents=True)
        remembered.write_text(json.dumps({"recent": [str(models / "gone.gltf"), str(models / NAME)], "bookmarks": {}}))
        viewer = self.view(None, *FEW, wait=False)
        viewer.window()
        viewer.click("recent 0")  # grey
        time.sleep(0.2)
        self.assertEqual((viewer.status()["state"], viewer.status()["error"]), ("empty", ""))
        viewer.click("recent 1")
        viewer.rest(lambda s: s["scene"].endswith(NAME), "the file shown before")

        # Nothing is asked, so the user is told how a file is shown; one to save gets a free name.
        viewer.key("ctrl+o")
        viewer.until(lambda s: any("drop a file here" in m for m in s["messages"]), "what to do")
        viewer.key("ctrl+s")
        picture = self.folder / (NAME[:-5] + "-1.png")
        viewer.until(lambda s: f"wrote {picture}" in s["messages"], "the picture")
        self.assertEqual(read_png(picture)[:2], (320, 240))
        self.ends_well(viewer, viewer.close())


class Folder(Case):
    def test_left_and_right_go_through_the_models_of_the_folder_or_the_ones_given(self):
        for name in ("b 9.gltf", "b 10.gltf", "a.gltf"):
            shutil.copy(SCENES / "furnace.gltf", self.folder / name)
        def goes(viewer, key, name):
            viewer.key(key)
            viewer.rest(lambda s: s["scene"] == str(self.folder / name), f"{key}: {name}")
        viewer = self.view(self.folder / "b 9.gltf", "--resolution", "160,120", "--spp", "1")
        for key, name in (("Right", "b 10.gltf"), ("Right", "a.gltf"), ("Left", "b 10.gltf"), ("Left", "b 9.gltf")):
            goes(viewer, key, name)
        self.ends_well(viewer, viewer.close())
        viewer = self.view(self.folder / "b 9.gltf", self.folder / "a.gltf", "--resolution", "160,120", "--spp", "1")
        for name in ("a.gltf", "b 9.gltf", "a.gltf"):
            goes(viewer, "Right", name)
        self.ends_well(viewer, viewer.close())
        (self.folder / "alone").mkdir()
        viewer = self.view((self.folder / "a.gltf").rename(self.folder / "alone/a.gltf"), "--resolution", "160,120", "--spp", "1")
        viewer.key("Left")
        viewer.until(lambda s: "there is no other model in this folder" in s["messages"], "nothing to go to")
        self.ends_well(viewer, viewer.close())


if __name__ == "__main__":
    main()
