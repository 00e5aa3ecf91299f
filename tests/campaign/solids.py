# SPDX-License-Identifier: MIT
"""Light in, through and next to solids: each cell of a matrix of cameras, lamps and receivers is drawn in ways that must agree, and compared with its closed form
where there is one. A tank of water holds what is inside; a box of glass in the tank holds a lamp in another solid. A case is one cell."""
import functools
import math
import struct
from pathlib import Path

from common import Finding, run
from gltf_file import Gltf

CAMERAS = ("outside", "glass", "absorbing", "scattering", "fog")
# Places of lamps, and the kinds that may stand there.
LAMPS = {"outside": ("point", "spot", "sun", "quad", "environment"), "tank": ("point", "spot", "quad"), "other": ("point", "spot", "quad")}
RECEIVERS = ("inside", "outside", "alpha", "thin")
CELLS = [(camera, place, kind, receiver) for camera in CAMERAS for place, kinds in LAMPS.items() for kind in kinds for receiver in RECEIVERS]
ASKED = {"cells": len(CELLS)}

IOR = 1.33
SIZE = 2.0  # half an edge of the tank
COLOR, DISTANCE = (0.5, 0.25, 0.1), 2.0
POWER = {"point": 5.0, "spot": 5.0, "sun": 2.0, "quad": 20.0}
SAMPLES, PIXELS = 64, 24


class Model(Gltf):
    """A glTF file in the making."""

    def __init__(self):
        super().__init__(materials=[])

    def body(self, points, triangles, material, at=(0, 0, 0)):
        self.root["materials"].append(material)
        indices, position = self.accessor([i for t in triangles for i in t], "I"), self.accessor(points)
        self.node(mesh=self.mesh(indices, position=position, material=len(self.root["materials"]) - 1), translation=list(at))

    def box(self, half, material, at=(0, 0, 0)):
        points = [(half * (1 if i & 1 else -1), half * (1 if i & 2 else -1), half * (1 if i & 4 else -1)) for i in range(8)]
        quads = ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6))
        self.body(points, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))], material, at)

    def plate(self, half, material, at):
        """A level square that faces up."""
        self.body([(-half, 0, half), (half, 0, half), (half, 0, -half), (-half, 0, -half)], [(0, 1, 2), (0, 2, 3)], material, at)

    def light(self, kind, at):
        lamp = {"type": {"sun": "directional"}.get(kind, kind), "intensity": POWER[kind]}
        if kind == "spot":
            lamp["spot"] = {"innerConeAngle": 1.2, "outerConeAngle": 1.4}
        self.root["extensions"] = {"KHR_lights_punctual": {"lights": [lamp]}}
        # It shines down.
        self.node(extensions={"KHR_lights_punctual": {"light": 0}}, translation=list(at), rotation=[-math.sqrt(0.5), 0, 0, math.sqrt(0.5)])

    def write(self, path):
        used = {name for m in self.root["materials"] for name in m.get("extensions", {})} | set(self.root.get("extensions", {}))
        if used:
            self.root["extensionsUsed"] = sorted(used)
        super().write(path)


def matt(color, alpha=1.0, **more):
    return {"pbrMetallicRoughness": {"baseColorFactor": [*color, alpha], "metallicFactor": 0, "roughnessFactor": 1},
            "extensions": {"KHR_materials_specular": {"specularFactor": 0}}, **more}


def glass(thickness=1.0, volume=None, **extensions):
    names = {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": IOR}}
    if thickness:
        names["KHR_materials_volume"] = {"thicknessFactor": thickness, **(volume or {})}
    names.update({"KHR_materials_" + name: value for name, value in extensions.items()})
    return {"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0, "roughnessFactor": 0}, "extensions": names}


def water(camera):
    if camera == "glass":
        return glass()
    volume = {"attenuationColor": list(COLOR), "attenuationDistance": DISTANCE}
    if camera == "scattering":
        return glass(volume=volume, scatter={"scatterStrengthFactor": 1, "multiscatterColorFactor": [0.6, 0.4, 0.2]})
    return glass(volume=volume)


FLOOR = {"inside": -1.5, "outside": -3.0, "alpha": -1.5, "thin": -1.5}
EYE = {True: 0.5, False: 3.5}  # of a camera inside of the tank, or outside


def lamp_place(place, receiver):
    if place == "outside":
        return (0.5, -2.5, 0) if receiver == "outside" else (0.5, 3.0, 0)
    return (0.9, -0.3, 0)


def scene(cell, folder):
    camera, place, kind, receiver = cell
    model = Model()
    model.box(SIZE, water(camera))
    model.plate(1.5, matt((0.8, 0.8, 0.8), doubleSided=True), (0, FLOOR[receiver], 0))
    if receiver == "alpha":
        model.plate(1.7, matt((0, 0, 0), 0.5, alphaMode="BLEND", doubleSided=True), (0, -1.0, 0))
    if receiver == "thin":
        model.plate(1.7, glass(0), (0, -1.0, 0))
    at = lamp_place(place, receiver)
    if place == "other":
        model.box(0.3, glass(volume={"attenuationColor": [0.3, 0.6, 0.8], "attenuationDistance": 0.5}), at)
    if kind == "quad":
        lamp = matt((0, 0, 0), doubleSided=True, emissiveFactor=[1, 1, 1])
        lamp["extensions"]["KHR_materials_emissive_strength"] = {"emissiveStrength": POWER[kind]}
        model.plate(0.15, lamp, at)
    elif kind != "environment":
        model.light(kind, at)
    path = folder / "cell.gltf"
    model.write(path)
    return path


def options(cell, way):
    camera, _, kind, receiver = cell
    inside = camera not in ("outside", "fog")
    eye = EYE[inside]
    words = ["--resolution", f"{PIXELS},{PIXELS}", "--camera-position", f"0,{eye},0", "--camera-focal-point", f"0,{FLOOR[receiver]},0", "--camera-view-up", "0,0,-1", "--no-default-light"]
    for option, usual in (("--bounces", 6), ("--camera-view-angle", 1)):
        if option not in way:
            words += [option, usual]
    if camera == "fog":
        words += ["--fog-density", 0.1, "--fog-distance", 6]
    if kind == "environment":
        words += ["--hdri-file", Path("sky.pfm")]
    return words


def write_sky(folder):
    """A map that is brighter above than below, without a sun."""
    rows = [b"".join(struct.pack("<3f", *(0.2 + 0.2 * y + 0.1 * (x % 3) for _ in range(3))) for x in range(8)) for y in range(4)]
    (folder / "sky.pfm").write_bytes(b"PF\n8 4\n-1.0\n" + b"".join(rows))


def pixels(path):
    body = path.read_bytes().split(b"\n", 3)[3]
    values = struct.unpack(f"<{len(body) // 4}f", body)
    return [values[i:i + 3] for i in range(0, len(values), 3)]


def mean_and_error(colors):
    """The mean of each channel, and its standard error."""
    result = []
    for values in zip(*colors):
        mean = math.fsum(values) / len(values)
        result.append((mean, math.sqrt(math.fsum((v - mean) ** 2 for v in values) / (len(values) - 1) / len(values))))
    return result


def irradiance(kind, place, height, lost):
    """What a lamp brings to the middle of a plate that lies so much below it, through a medium that loses so much light per metre."""
    x, _, z = place
    if kind == "quad":
        points = [(x + 0.15 * (2 * i - 15) / 16, z + 0.15 * (2 * j - 15) / 16) for i in range(16) for j in range(16)]
        each = POWER[kind] * (0.3 / 16) ** 2 * height * height
        return math.fsum(each / r ** 4 * math.exp(-lost * r) for r in (math.sqrt(a * a + b * b + height * height) for a, b in points))
    distance = math.hypot(x, height)
    if kind == "spot" and math.acos(height / distance) > 1.2:
        return 0.0
    return POWER[kind] * height / distance ** 3 * math.exp(-lost * distance)


def closed_form(cell):
    """The radiance that a lamp makes at the middle of the receiver as the camera sees it, without light that has bounced; none where that is no product."""
    camera, place, kind, receiver = cell
    if kind == "environment" or camera in ("scattering", "fog") or (kind == "quad" and receiver == "thin"):
        return None
    inside, within = camera != "outside", receiver != "outside"
    lost = [-math.log(c) / DISTANCE if camera != "glass" else 0.0 for c in COLOR]
    passes = 1 - ((IOR - 1) / (IOR + 1)) ** 2
    way = (EYE[True] if inside else SIZE) - (FLOOR[receiver] if within else -SIZE)
    factor = passes ** (2 if not within and not inside else int(inside != within)) * IOR ** (2 * (int(inside) - int(within)))
    if receiver == "thin":
        factor *= (1 - (1 - passes)) ** 2 / (1 - (1 - passes) ** 2)
    if receiver == "alpha":
        factor *= 0.5
    # The sun comes from above the tank. Behind a wall that bends light a quad is met by rays, which is no product.
    lit = place == ("tank" if within else "outside") and receiver != "thin" and kind != "sun"
    if not lit:
        return None if kind == "quad" else [0.0] * 3
    at = lamp_place(place, receiver)
    factor *= 0.8 / math.pi * (0.5 if receiver == "alpha" else 1)
    return [factor * math.exp(-a * way) * irradiance(kind, at, at[1] - FLOOR[receiver], a if within else 0.0) for a in lost]


def forms(cell, compared):
    """Pairs of ways to draw the cell that must have one mean. Schedules and caustics take long to compile, and are compared where they are named."""
    camera, _, kind, _ = cell
    plain = ("--caustics", "off", "--schedule", "megakernel")
    pairs = [(plain, plain[:3] + ("wavefront",))] if "schedules" in compared else []
    if kind in ("quad", "environment"):
        pairs.append((plain, plain + ("--disable", "light-sampling")))
        pairs.append((plain + ("--bounces", 0), plain + ("--bounces", 0, "--disable", "light-sampling")))
    if "caustics" in compared and kind == "quad" and camera not in ("scattering", "fog"):
        wide = ("--camera-view-angle", 50)  # light paths land anywhere
        pairs.append((plain + wide, ("--caustics", "on") + wide))
    return pairs


def faults(cell, draw, compared):
    """What is wrong with a cell, a line each. draw(options, samples, seed) returns the colours of a picture."""
    found = []
    for pair in forms(cell, compared):
        for samples, limit in ((SAMPLES, 4.0), (4 * SAMPLES, 5.0)):  # what looks wrong is drawn again
            a, b = (mean_and_error(draw(way, samples, seed)) for seed, way in enumerate(pair, 7))
            apart = [(x, y) for (x, dx), (y, dy) in zip(a, b) if abs(x - y) > limit * math.hypot(dx, dy) + 2e-3 * max(x, y) + 1e-6]
            if not apart:
                break
        else:
            found.append(f"{' '.join(map(str, pair[0]))} gives {[round(x, 6) for x, _ in a]}, {' '.join(map(str, pair[1]))} {[round(x, 6) for x, _ in b]}")
    right = closed_form(cell)
    if right is not None:
        seen = mean_and_error(draw(("--caustics", "off", "--schedule", "megakernel", "--bounces", 0), SAMPLES, 7))
        if any(abs(x - r) > 5 * dx + 0.01 * r + 1e-6 for (x, dx), r in zip(seen, right)):
            found.append(f"direct light is {[round(x, 6) for x, _ in seen]}, the closed form {[round(r, 6) for r in right]}")
    return found


def prepare(ground):
    return None


def last(_):
    return len(CELLS)


def case(ground, _, number, folder, compared=("schedules", "caustics")):
    cell = CELLS[number]
    path = scene(cell, folder)
    write_sky(folder)

    @functools.cache
    def draw(way, samples, seed):
        output = folder / "cell.pfm"
        result = run(ground, ["render", path.name, "-o", output.name, "--quiet", "--spp", samples, "--seed", seed, *options(cell, way), *way], folder)
        if result.status != 0:
            raise Finding(f"{cell}: status {result.status}: {result.error.strip()}")
        return pixels(output)

    wrong = faults(cell, draw, compared)
    if wrong:
        raise Finding(f"{', '.join(cell)}: {'; '.join(wrong)}")
    return {"cells": 1}
