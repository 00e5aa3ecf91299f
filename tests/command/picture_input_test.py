#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Pictures of other programs as input: what their headers say about orientation, scale, primaries, windows and parts counts."""
import itertools
import math
import os
import struct

from support import FRAGTRACE, SCENES, Case, Exr, main, read_pfm, run, write_exr, write_parts

W, H = 3, 2
# Powers of two: RGBE holds them.
PIXELS = [tuple(2.0 ** (3 * i + c - 6) for c in range(3)) for i in range(W * H)]
FAKE = FRAGTRACE.parent / "fake_oidn/libOpenImageDenoise.so.2"
REC709 = (0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329)
ACESCG = (0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767)


def rgbe(pixel):
    exponent = max(math.frexp(v)[1] for v in pixel)
    return bytes(int(math.ldexp(v, 8 - exponent)) for v in pixel) + bytes([exponent + 128])


def planes(pixels, names="RGB"):
    return {name: [pixel[c] for pixel in pixels] for c, name in enumerate(names)}


class PicturesAsInput(Case):
    def hdr(self, resolution, places, header=""):
        """A file of scan lines that hold these places of the picture, one after the other."""
        path = self.folder / "in.hdr"
        pixels = b"".join(rgbe(PIXELS[y * W + x]) for x, y in places)
        path.write_bytes(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n{header}\n{resolution}\n".encode() + pixels)
        return path

    def pfm(self, pixels, scale=-1.0, name="in.txt"):
        path = self.folder / name  # Case.tearDown reads pictures by their names
        rows = [pixels[y * W:(y + 1) * W] for y in range(H)]
        path.write_bytes(f"PF\n{W} {H}\n{scale}\n".encode() + b"".join(struct.pack("<3f", *pixel) for row in reversed(rows) for pixel in row))
        return path

    def right(self, pixels=PIXELS):
        """The picture itself."""
        path = self.folder / "right.exr"
        write_exr(path, W, H, planes(pixels))
        return path

    def differs(self, a, b, says=""):
        result = run("diff", a, b, "--metric", "max")
        self.assertIn(result.returncode, (0, 1), result.stderr)
        self.assertIn(says, result.stderr)
        self.assertEqual(bool(says), bool(result.stderr), result.stderr)
        return float(result.stdout.split()[0])

    def drawn(self, path, says=(), **options):
        """The map as a panorama shows it."""
        output = self.folder / "drawn.pfm"
        result = self.renders(SCENES / "sphere-plane.gltf", "-o", output, "--hdri-file", path, "--stage", "flat", "--resolution", "24,12", "--spp", "1",
                              "--camera-type", "panorama", **options)
        for text in says:
            self.assertIn(text, result.stderr)
        return read_pfm(output)

    def test_an_hdr_is_turned_as_its_resolution_says(self):
        for first, right, down in itertools.product("YX", (True, False), (True, False)):
            x, y = ("+X" if right else "-X", "-Y" if down else "+Y")
            columns, rows = (range(W) if right else range(W - 1, -1, -1)), (range(H) if down else range(H - 1, -1, -1))
            if first == "Y":
                path = self.hdr(f"{y} {H} {x} {W}", [(c, r) for r in rows for c in columns])
            else:
                path = self.hdr(f"{x} {W} {y} {H}", [(c, r) for c in columns for r in rows])
            self.assertEqual(self.differs(path, self.right()), 0, (first, x, y))

    def test_exposures_of_an_hdr_are_taken_back(self):
        places = [(x, y) for y in range(H) for x in range(W)]
        path = self.hdr(f"-Y {H} +X {W}", places, "EXPOSURE=2.0\nSOFTWARE=x\nEXPOSURE= 4\n")
        self.assertEqual(self.differs(path, self.right([tuple(v / 8 for v in p) for p in PIXELS]), says="in.hdr: is divided by its EXPOSURE, 8"), 0)
        path = self.hdr(f"-Y {H} +X {W}", places, "COLORCORR=1 2 4\nEXPOSURE=2\n")
        self.assertEqual(self.differs(path, self.right([(p[0] / 2, p[1] / 4, p[2] / 8) for p in PIXELS]), says="COLORCORR, 2, 4, 8"), 0)
        for value in ("0", "-1", "nan", "abc", "inf", "1e999", ""):
            path = self.hdr(f"-Y {H} +X {W}", places, f"EXPOSURE={value}\n")
            self.assertEqual(self.differs(path, self.right(), says="has an EXPOSURE or COLORCORR that is no number above 0, and is ignored"), 0)
        path = self.hdr(f"-Y {H} +X {W}", places, "EXPOSURE=1\n")
        self.assertEqual(self.differs(path, self.right()), 0)

    def test_headers_of_an_hdr(self):
        """Without a FORMAT, with white space at the end of lines; one of another format is refused by name."""
        pixels = b"".join(map(rgbe, PIXELS))
        path = self.folder / "in.hdr"
        for head, says in (("#?RADIANCE\n", "has no FORMAT in its header, and is read as 32-bit_rle_rgbe"), ("#?RGBE\n# by hand\nFORMAT= 32-bit_rle_rgbe \n", ""),
                           ("#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\n\r", "")):
            path.write_bytes(head.encode() + f"\n-Y {H} +X {W}\n".encode() + pixels)
            self.assertEqual(self.differs(path, self.right(), says=says), 0, head)
        for form in ("32-bit_rle_xyze", "\x1b[2J"):
            path.write_bytes(f"#?RADIANCE\nFORMAT={form}\n\n-Y {H} +X {W}\n".encode() + pixels)
            self.fails(3, "diff", path, self.right(), says=["its FORMAT is not 32-bit_rle_rgbe, the only one that is read"])

    def test_comments_of_a_pfm(self):
        plain = self.pfm(PIXELS).read_bytes()
        pixels = plain.split(b"\n", 3)[3]
        path = self.folder / "in.txt"
        for head in ("PF\n# by hand\n3 2\n-1.0\n", "PF # PF\n3 # width\n2\n#\n# 7\n-1.0\n", "PF\n3 2\n-1.0\n# by hand\n"):
            path.write_bytes(head.encode() + pixels)
            self.assertEqual(self.differs(path, self.right()), 0, head)
        first = struct.unpack("<f", b"#\n#\n")[0]  # pixels that look like a comment
        values = [PIXELS[0]] * 3 + [(first, 1.0, 1.0)] + [PIXELS[0]] * 2
        self.assertEqual(self.differs(self.pfm(values), self.right(values)), 0)
        for head, says in (("PF\n3 x\n-1.0\n", "it has no height"), ("PF\n3 2\n0\n", "it has no scale"), ("PF\n# 3 2\n", "it has no ")):
            path.write_bytes(head.encode() + pixels)
            self.fails(3, "diff", path, self.right(), says=["the PFM header is wrong: " + says])

    def test_the_scale_of_a_pfm_counts(self):
        self.assertEqual(self.differs(self.pfm(PIXELS, -3.0), self.right([tuple(3 * v for v in p) for p in PIXELS])), 0)

    def test_other_primaries_are_converted(self):
        """(0.8, 0.2, 0.1) of Rec. 709 in ACEScg, whose white is another, and in CIE XYZ, from tables of their standards."""
        path = self.folder / "in.exr"
        for primaries, color in ((ACESCG, (0.5631205, 0.2407710, 0.1253879)), ((1, 0, 0, 1, 0, 0, 0.3127, 0.329), (0.4413435, 0.3203642, 0.1233698))):
            write_exr(path, W, H, {**planes([color] * (W * H)), "albedo.R": color[0], "albedo.G": color[1], "albedo.B": color[2], "N.X": 0.25, "N.Y": 0.5, "N.Z": 1},
                      chromaticities=primaries)
            self.assertLess(self.differs(path, self.right([(0.8, 0.2, 0.1)] * 6), says="in.exr: has other primaries than Rec. 709"), 1e-5)
            # Colours of layers are converted, too, directions are not.
            output = self.folder / "out.exr"
            result = run("denoise", path, "-o", output, "--oidn-library", FAKE, env={**os.environ, "FAKE_OIDN": ""})
            self.assertIn("in.exr: has other primaries than Rec. 709", result.stderr)
            picture = Exr(output)
            for channel, value in (("noisy.G", 0.2), ("albedo.R", 0.8), ("albedo.B", 0.1), ("N.X", 0.25), ("N.Z", 1)):
                self.assertAlmostEqual(picture.values(channel)[0], value, delta=1e-5)
            for a, b in zip(picture.numbers["chromaticities"], REC709):
                self.assertAlmostEqual(a, b, delta=1e-6)
        output.unlink()
        write_exr(path, W, H, planes(PIXELS), chromaticities=REC709)
        self.assertEqual(self.differs(path, self.right()), 0)
        write_exr(path, W, H, planes(PIXELS), chromaticities=(0,) * 8)
        self.assertEqual(self.differs(path, self.right(), says="span no colours"), 0)

    def test_overscan_is_cut_to_the_display_window(self):
        path = self.folder / "in.exr"
        window = (-2, -1, W, H + 2)
        width, height = window[2] - window[0] + 1, window[3] - window[1] + 1
        larger = {(x, y): PIXELS[y * W + x] if 0 <= x < W and 0 <= y < H else (99.0,) * 3 for y in range(window[1], window[3] + 1) for x in range(window[0], window[2] + 1)}
        write_exr(path, W, H, planes(list(larger.values())), window=window)
        self.assertEqual(len(larger), width * height)
        self.assertEqual(self.differs(path, self.right(), says="in.exr: has 6 x 6 pixels, some of them outside of its display window of 3 x 2, which are cut"), 0)
        # A window that is beyond the display window on one side only.
        write_exr(path, W, H, planes([PIXELS[y * W + 2] if x == 2 else (99.0,) * 3 for y in range(H) for x in range(2, 5)]), window=(2, 0, 4, H - 1))
        self.assertEqual(self.differs(path, self.right([p if i % W == 2 else (0, 0, 0) for i, p in enumerate(PIXELS)]), says="which are cut"), 0)
        write_exr(path, W, H, planes(PIXELS), window=(10, 0, 12, 1))
        self.fails(3, "diff", path, self.right(), says=["its data window is outside of its display window"])

    def test_all_parts_of_an_exr_are_read(self):
        path, output = self.folder / "in.parts", self.folder / "out.exr"
        self.renders(SCENES / "cornell-box.gltf", "-o", self.folder / "one.exr", "--quiet", "--resolution", "24,16", "--spp", 4, "--aov", "denoising")
        one = Exr(self.folder / "one.exr")
        plane = lambda names: {name: one.values(name) for name in names}
        rest = [name for name in one.layers if "." in name]
        write_parts(path, (24, 16), [{"name": "ViewLayer.Combined", "layers": plane("RGB")}, {"name": "rest", "layers": plane(rest)}])
        for source in (path, self.folder / "one.exr"):
            run("denoise", source, "-o", output, "--denoise", "variance", check=True)
            picture = Exr(output)
            output.unlink()
            filtered = picture.layers if source == path else filtered
        self.assertEqual(filtered, picture.layers)
        self.assertIn("denoising.albedo.R", filtered)

    def test_guides_of_other_parts_are_used(self):
        path = self.folder / "in.parts"
        gray = planes([(0.5,) * 3] * (W * H))
        layers = {"Combined": gray, "Denoising Albedo": gray, "Denoising Normal": planes([(0, 0, 1)] * (W * H), "XYZ"), "Denoising Depth": {"Z": 1.0}}
        write_parts(path, (W, H), [{"name": "ViewLayer." + name, "layers": layer} for name, layer in layers.items()])
        result = run("denoise", path, "-o", self.folder / "out.exr", "--oidn-library", FAKE)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        picture = Exr(self.folder / "out.exr")
        self.assertEqual(set(picture.layers), {*"RGB", *(f"noisy.{c}" for c in "RGB"), *(f"ViewLayer.Denoising Albedo.{c}" for c in "RGB"),
                                               *(f"ViewLayer.Denoising Normal.{c}" for c in "XYZ"), "ViewLayer.Denoising Depth.Z"})

    def test_the_colour_may_be_in_any_part(self):
        path = self.folder / "in.parts"
        depth = {"name": "depth", "layers": {"Z": 7.0}}
        normal = {"name": "N", "layers": planes([(0.25, 0.5, 1.0)] * (W * H))}
        color = {"name": "rgba", "layers": planes(PIXELS)}
        for parts in itertools.permutations((depth, normal, color)):
            write_parts(path, (W, H), parts)
            self.assertEqual(self.differs(path, self.right()), 0)
        # The first of parts that no name tells apart; each part has a window of its own.
        write_parts(path, (W, H), [depth, {**color, "name": "left"}, {**normal, "name": "right", "window": (1, 0, 2, 0), "layers": planes([(9.0,) * 3] * 2)}])
        self.assertEqual(self.differs(path, self.right()), 0)
        self.assertEqual(self.drawn(path), self.drawn(self.right()))

    def test_a_map_may_hold_what_is_no_light(self):
        values = [(math.inf, 1.0, math.nan), (-1.0, 1.0, 1.0)] + [(1.0,) * 3] * 4
        settled = [(65504.0, 1.0, 0.0), (0.0, 1.0, 1.0)] + [(1.0,) * 3] * 4
        picture = self.drawn(self.pfm(values), says=["warning: ", "in.txt: 1 value without bound, taken as 65504", "in.txt: 1 value that is no number, taken as 0",
                                                     "in.txt: 1 value below 0"])
        self.assertEqual(picture, self.drawn(self.pfm(settled)))
        self.drawn(self.pfm([(math.nan,) * 3] + [(1.0,) * 3] * 5), says=["in.txt: 3 values that are no numbers, taken as 0"])


if __name__ == "__main__":
    main()
