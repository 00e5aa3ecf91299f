#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench/fidelity, as Khronos' generator of render-fidelity pictures calls an engine: its paths, its camera, its curve."""
import json
import os
import subprocess

from support import FRAGTRACE, SCENES, Case, main, quad, read_png, write_pfm

SCRIPT = SCENES.parent / "bench/fidelity"
COLOR = (0.4, 0.1, 0.05)  # colour of a quad without light
ABOVE, BELOW = (0.1, 0.2, 0.7), (0.2, 0.3, 0.1)  # colours of the environment
TO_ACES = ((0.59719, 0.35458, 0.04823), (0.07600, 0.90834, 0.01566), (0.02840, 0.13383, 0.83777))
FROM_ACES = ((1.60475, -0.53108, -0.07367), (-0.10208, 1.10813, -0.00605), (-0.00327, -0.07276, 1.07602))


def shown(color):
    """Returns the bytes of three.js' ACESFilmicToneMapping and gamma 2.2."""
    v = [sum(m * c / 0.6 for m, c in zip(row, color)) for row in TO_ACES]
    v = [(x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.4329510) + 0.238081) for x in v]
    return [255 * max(sum(m * x for m, x in zip(row, v)), 0) ** (1 / 2.2) for row in FROM_ACES]


class Fidelity(Case):
    def setUp(self):
        super().setUp()
        gltf = quad({"pbrMetallicRoughness": {"baseColorFactor": [*COLOR, 1]}, "extensions": {"KHR_materials_unlit": {}}})
        # Faces +x, and is a metre wide.
        gltf["nodes"][0] |= {"translation": [0.2, 0.5, -0.3], "rotation": [0, 0.5**0.5, 0, 0.5**0.5], "scale": [0.5, 0.5, 1]}
        (self.folder / "assets").mkdir()
        (self.folder / "assets/quad.gltf").write_text(json.dumps(gltf))
        write_pfm(self.folder / "assets/sky.pfm", 8, 32, lambda x, y: ABOVE if y < 16 else BELOW)

    def draw(self, skybox, *options, model="quad", **orbit):
        """Draws a scenario with relative paths as the generator writes them."""
        scenario = {"name": "quad", "model": f"../../../assets/{model}.gltf", "lighting": "../../../assets/sky.pfm", "renderSkybox": skybox, "verticalFoV": 45,
                    "dimensions": {"width": 32, "height": 16}, "target": {"x": 0.2, "y": 0.5, "z": -0.3}, "orbit": {"theta": 90, "phi": 90, "radius": 2} | orbit}
        self.output = self.folder / "test/goldens/quad/fragtrace-golden.png"
        return subprocess.run([SCRIPT, *options, json.dumps({"scenario": scenario, "outputFile": str(self.output)})], cwd=self.folder, capture_output=True, text=True,
                              env=os.environ | {"FRAGTRACE": str(FRAGTRACE)})

    def assert_shown(self, pixel, color):
        for byte, wanted in zip(pixel, shown(color)):
            self.assertLess(abs(byte - wanted), 1, (list(pixel), shown(color)))

    def test_a_cut_out(self):
        drawn = self.draw(False, "--spp", "4")
        self.assertEqual((drawn.returncode, drawn.stderr), (0, ""))
        width, height, rows, step = read_png(self.output)
        self.assertEqual((width, height, step), (64, 32, 4))
        pixel = lambda x, y: rows[y][4 * x:4 * x + 4]
        self.assert_shown(pixel(32, 16), COLOR)
        # Half a metre is 9.66 rows of 32 within 45 degrees at 2 m.
        self.assertEqual([pixel(x, y)[3] for x, y in ((23, 16), (40, 16), (32, 7), (32, 24))], [255] * 4)
        self.assertEqual([pixel(x, y)[3] for x, y in ((21, 16), (42, 16), (32, 5), (32, 26))], [0] * 4)

    def test_with_a_skybox_and_from_above(self):
        drawn = self.draw(True, "--spp", "4", phi=60)
        self.assertEqual((drawn.returncode, drawn.stderr), (0, ""))
        step, rows = read_png(self.output)[3], read_png(self.output)[2]
        self.assertEqual(step, 3)
        self.assert_shown(rows[0][:3], BELOW)
        self.assert_shown(rows[16][3 * 32:3 * 33], COLOR)
        # 30 degrees above it, its upper edge is 1.75 m ahead and 0.43 m up: 9.5 rows; the lower one is 2.25 m ahead: 7.4 rows.
        self.assert_shown(rows[7][3 * 32:3 * 33], COLOR)
        self.assert_shown(rows[24][3 * 32:3 * 33], BELOW)

    def test_from_the_target_itself_and_what_is_missing(self):
        """A radius of 0 looks the way in which others would look at the target: from below, upwards."""
        self.assertEqual(self.draw(True, "--spp", "1", radius=0, phi=120).returncode, 0)
        self.assert_shown(read_png(self.output)[2][16][3 * 32:3 * 33], ABOVE)
        self.output.unlink()
        for told, wanted in ((self.draw(True, model="none"), "none.gltf"), (self.draw(True, "--colour"), "--colour")):
            self.assertEqual(told.returncode, 1)
            self.assertIn(wanted, told.stderr)
            self.assertFalse(self.output.exists())


if __name__ == "__main__":
    main()
