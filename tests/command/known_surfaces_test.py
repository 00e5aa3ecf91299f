#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Squares under one directional light, seen straight on: each has one colour, which is a formula of glTF 2.0's appendix B or of an extension, within 3e-4."""
import math

from support import SQUARE, TWO_TRIANGLES, Case, Gltf, data_uri, main, png, quad

ANGLE = 0.3  # angle between light and normal
LIGHT = (math.sin(ANGLE), 0, math.cos(ANGLE))
HALF = (math.sin(ANGLE / 2), 0, math.cos(ANGLE / 2))
IRRADIANCE = 2 * math.cos(ANGLE)
BLACK = {"KHR_materials_specular": {"specularFactor": 0}}
COLOR = [0.8, 0.5, 0.3]
CORNERS = ((0.9, 0.2, 0.4), (0.5, 0.7, 0.1), (0.1, 0.9, 0.8), (0.6, 0.3, 0.2))  # vertex colours
NORMAL = (-0.6, 0, 0.8)
TANGENT = (0.6, 0.8, 0, -1)
TEXEL = (180, 90, 230)
KEPT = [t / 255 for t in TEXEL]
SIDE = 16  # pixels of a square


def schlick(f0, cosine):
    return f0 + (1 - f0) * (1 - cosine)**5


def facets(along, across, turned=0.0):
    """Value of the specular lobe that reflects all, for facets of these widths along an axis that is turned from x, and across it."""
    c, s = math.cos(turned), math.sin(turned)
    h, light = ((c * v[0], -s * v[0], v[2]) for v in (HALF, LIGHT))

    def smith(v):
        return (math.sqrt(1 + ((along * v[0])**2 + (across * v[1])**2) / v[2]**2) - 1) / 2

    distribution = 1 / (math.pi * along * across * ((h[0] / along)**2 + (h[1] / across)**2 + h[2]**2)**2)
    return distribution / ((1 + smith((0, 0, 1)) + smith(light)) * 4 * LIGHT[2])


def film(base, index, thickness):
    """Returns the reflectance of facets under a thin film (Belcour and Barla, 2017; KHR_materials_iridescence), a
    triple."""
    inside = math.sqrt(1 - (1 - HALF[2]**2) / index**2)
    top = schlick(((index - 1) / (index + 1))**2, HALF[2])
    result, terms = [], []
    for f0 in base:
        root = math.sqrt(f0 + 1e-4)
        below = (1 + root) / (1 - root)
        bottom = schlick(((below - index) / (below + index))**2, inside)
        both = top * bottom
        total = (1 - top)**2 * bottom / (1 - both)
        result.append(top + total)
        shift = math.pi + (math.pi if below < index else 0)
        terms.append([((total - (1 - top)) * math.sqrt(both)**order, shift * order) for order in (1, 2)])
    for order in (1, 2):
        phase = 2e-9 * math.pi * 2 * index * thickness * inside * order
        shifts = [t[order - 1][1] for t in terms]
        gaussian = lambda height, place, width, shift: height * math.sqrt(2 * math.pi * width) * math.cos(place * phase + shift) * math.exp(-phase**2 * width)
        xyz = [gaussian(*curve, shift) / 1.0685e-7 for curve, shift in zip(
            ((5.4856e-13, 1.6810e6, 4.3278e9), (4.4201e-13, 1.7953e6, 9.3046e9), (5.2481e-13, 2.2084e6, 6.6121e9)), shifts)]
        xyz[0] += gaussian(9.7470e-14, 2.2399e6, 4.5282e9, shifts[0]) / 1.0685e-7
        rows = ((3.2404542, -1.5371385, -0.4985314), (-0.9692660, 1.8760108, 0.0415560), (0.0556434, -0.2040259, 1.0572252))
        seen = [sum(a * b for a, b in zip(row, xyz)) for row in rows]
        result = [r + 2 * t[order - 1][0] * value for r, t, value in zip(result, terms, seen)]
    return [min(max(r, 0), 1) for r in result]


def velvet(alpha, outgoing=(0, 0, 1), light=LIGHT):
    """Returns the value of white sheen, divided by the cosine of `outgoing` (Estevez and Kulla, 2017)."""
    def fit(x):
        t = (1 - alpha)**2
        a, b, c, d, e = (t * p + (1 - t) * q for p, q in ((25.3245, 21.5473), (3.32435, 3.82987), (0.16801, 0.19823), (-1.27393, -1.97760), (-4.85967, -4.32054)))
        return a / (1 + b * x**c) + d * x + e

    smith = lambda cosine: math.exp(fit(cosine)) if cosine < 0.5 else math.exp(2 * fit(0.5) - fit(1 - cosine))
    half = [o + i for o, i in zip(outgoing, light)]
    sine = math.hypot(*half[:2]) / math.hypot(*half)
    distribution = (2 + 1 / alpha) * sine**(1 / alpha) / (2 * math.pi)
    return distribution / ((1 + smith(outgoing[2]) + smith(light[2])) * 4 * light[2] * outgoing[2])


def velvet_albedo(alpha, direction, steps=64):
    """The part of the light from `direction` that white sheen sends out, by midpoints; close together at the horizon, where the lobe lies."""
    def part(j, k):
        root, turn = (j + 0.5) / steps, math.pi * (k + 0.5) / steps  # over half a circle: the other is its mirror image
        cosine = root**2
        sine = math.sqrt(1 - cosine**2)
        return 2 * root * cosine * velvet(alpha, (sine * math.cos(turn), sine * math.sin(turn), cosine), direction)

    return 2 * math.pi / steps**2 * sum(part(j, k) for j in range(steps) for k in range(steps))


def bent():
    """Returns the value of a Lambert surface under an interpolated normal, faded towards the horizon of the triangle
    (docs/design/numerics.md, Shading)."""
    cosine = sum(n * l for n, l in zip(NORMAL, LIGHT))
    g = min(1, LIGHT[2] / (cosine * NORMAL[2]))
    return cosine * g * (1 + g - g * g)


def mapped(scale):
    """Returns the normal of a map of one texel."""
    x, y, z = ((2 * t - 1) * times for t, times in zip(KEPT, (scale, scale, 1)))
    side = TANGENT[3]  # the second axis is normal x tangent x this
    n = (x * TANGENT[0] - y * side * TANGENT[1], x * TANGENT[1] + y * side * TANGENT[0], z)
    return [c / math.hypot(*n) for c in n]


def coated(alpha, scale):
    """Returns the share of a clearcoat over a normal of its own, and the value of its lobe times the cosine."""
    n = mapped(scale)
    seen, lit, half = n[2], sum(a * b for a, b in zip(n, LIGHT)), sum(a * b for a, b in zip(n, HALF))
    smith = lambda cosine: (math.sqrt(1 + alpha**2 * (1 / cosine**2 - 1)) - 1) / 2
    distribution = alpha**2 / (math.pi * (half**2 * (alpha**2 - 1) + 1)**2)
    return schlick(0.04, seen), distribution / ((1 + smith(seen) + smith(lit)) * 4 * seen)


def base(metallic, roughness, color=(0, 0, 0), **extensions):
    return {"pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": metallic, "roughnessFactor": roughness},
            "extensions": {"KHR_materials_" + name: values for name, values in extensions.items()}}


def expected_base(metallic, roughness, specular=1.0, ior=1.5, tint=(1, 1, 1)):
    lobe = facets(roughness**2, roughness**2)
    f0 = [min(1, ((ior - 1) / (ior + 1))**2 * t) * specular for t in tint]
    dielectric = [f + (specular - f) * (1 - HALF[2])**5 for f in f0]
    return [IRRADIANCE * (metallic * schlick(c, HALF[2]) * lobe + (1 - metallic) * (d * lobe + (1 - max(dielectric)) * c / math.pi))
            for c, d in zip(COLOR, dielectric)]


def squares():
    """Materials and the colours that they show."""
    none = {"specularFactor": 0}
    strength = KEPT[2]  # strength of the anisotropy, whose direction is in red and green
    stretched = (0.09 + 0.91 * (0.6 * strength)**2, 0.09, 0.5 + math.atan2(2 * KEPT[1] - 1, 2 * KEPT[0] - 1))
    texture = {"index": 0}
    share, lobe = coated(0.25, 0.4)
    lit = sum(a * b for a, b in zip(mapped(0.7), LIGHT))
    under = 1 - max(COLOR) * max(velvet_albedo(0.5625, d) for d in (LIGHT, (0, 0, 1)))  # the share that sheen lets pass
    coat = 0.9 * 0.04  # seen straight on
    absorbed = [math.exp(math.log(c) * 0.5 / 0.7) for c in COLOR]  # half a metre, of 0.7 in which COLOR is left
    return [
        (base(1, 0.3, COLOR), expected_base(1, 0.3)),
        (base(0.4, 0.4, COLOR, specular={"specularFactor": 0.8, "specularColorFactor": [1, 0.5, 0.7]}, ior={"ior": 1.8}),
         expected_base(0.4, 0.4, 0.8, 1.8, (1, 0.5, 0.7))),
        (base(0, 1, specular=none, clearcoat={"clearcoatFactor": 0.9, "clearcoatRoughnessFactor": 0.3}), 3 * [IRRADIANCE * coat * facets(0.09, 0.09)]),
        (base(0, 1, COLOR, specular=none, clearcoat={"clearcoatFactor": 0.9}), [IRRADIANCE * (1 - coat) * c / math.pi for c in COLOR]),
        (base(0, 1, specular=none, sheen={"sheenColorFactor": COLOR, "sheenRoughnessFactor": 0.8}), [IRRADIANCE * c * velvet(0.64) for c in COLOR]),
        (base(0, 1, COLOR, specular=none, sheen={"sheenColorFactor": COLOR, "sheenRoughnessFactor": 0.75}),
         [IRRADIANCE * c * (velvet(0.5625) + under / math.pi) for c in COLOR]),
        (base(1, 0.3, COLOR, anisotropy={"anisotropyStrength": 0.6, "anisotropyRotation": 0.5, "anisotropyTexture": texture}),
         [IRRADIANCE * schlick(c, HALF[2]) * facets(*stretched) for c in COLOR]),
        (base(1, 0.3, COLOR, iridescence={"iridescenceFactor": 0.7, "iridescenceIor": 1.4, "iridescenceThicknessMaximum": 420}),
         [IRRADIANCE * facets(0.09, 0.09) * (0.7 * f + 0.3 * schlick(c, HALF[2])) for c, f in zip(COLOR, film(COLOR, 1.4, 420))]),
        (base(0, 1, COLOR, specular=none, diffuse_transmission={"diffuseTransmissionFactor": 0.3, "diffuseTransmissionColorFactor": [0, 0, 0]}), [IRRADIANCE * 0.7 * c / math.pi for c in COLOR]),
        (base(0, 1, COLOR, specular=none), [2 * bent() * c / math.pi for c in COLOR]),
        (base(0, 1, COLOR, specular=none, clearcoat={"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.5, "clearcoatNormalTexture": texture | {"scale": 0.4}})
         | {"normalTexture": texture | {"scale": 0.7}}, [2 * (share * lobe + (1 - share) * lit * c / math.pi) for c in COLOR]),
        (base(0, 1, (1, 1, 1), unlit={}), [sum(c[i] for c in CORNERS[:3]) / 6 + (CORNERS[0][i] + CORNERS[2][i] + CORNERS[3][i]) / 6 for i in range(3)]),
        (base(0, 0, (1, 1, 1), ior={"ior": 1.0}, transmission={"transmissionFactor": 1}, specular=none,
              volume={"thicknessFactor": 1, "attenuationColor": COLOR, "attenuationDistance": 0.7}), absorbed),
    ]


class KnownSurfaces(Case):
    def scene(self, materials, turned):
        count = len(materials)
        gltf = Gltf(materials=materials, textures=[{"source": 0}], images=[{"uri": data_uri("image/png", png(1, 1, [*TEXEL, 255]))}],
                    cameras=[{"type": "orthographic", "orthographic": {"xmag": count, "ymag": 1, "zfar": 10, "znear": 0.1}}],
                    extensions={"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 2}]}})
        position, uv, indices = gltf.accessor(SQUARE), gltf.accessor([(0, 1), (1, 1), (1, 0), (0, 0)]), gltf.accessor(TWO_TRIANGLES, "H")
        last = ({"normal": gltf.accessor([NORMAL] * 4)}, {"normal": gltf.accessor([(0, 0, 1)] * 4), "tangent": gltf.accessor([TANGENT] * 4)},
                {"color_0": gltf.accessor(CORNERS)}, {})
        for i in range(count):
            more = last[i - count] if i >= count - 4 else {}
            gltf.node(mesh=gltf.mesh(indices, position=position, texcoord_0=uv, material=i, **more), translation=[2 * i - count + 1, 0, 0])
        # The last is a slab half a metre thick, with an unlit white square behind it.
        gltf.node(mesh=count - 1, translation=[count - 1, 0, -0.5], rotation=[0, 1, 0, 0])
        gltf.node(mesh=gltf.mesh(indices, position=position, material=count - 2), translation=[count - 1, 0, -1])
        gltf.node(camera=0, translation=[0, 0, 5])
        gltf.node(rotation=[0, math.sin(turned / 2), 0, math.cos(turned / 2)], extensions={"KHR_lights_punctual": {"light": 0}})
        return gltf.document()

    def shown(self, known, turned=ANGLE):
        path = self.written("squares.gltf", self.scene([material for material, _ in known], turned))
        picture = self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", f"{len(known) * SIDE},{SIDE}", "--spp", 16, "--bounces", 3,
                               "--disable", "energy-compensation")
        for i, (material, colors) in enumerate(known):
            for c, color in enumerate(colors):
                seen = sum(row[SIDE * i + x][c] for row in picture for x in range(SIDE)) / SIDE**2
                self.assertAlmostEqual(seen / color, 1, delta=3e-4, msg=material)

    def test_light_from_before(self):
        self.shown(squares())

    def test_light_from_behind(self):
        through = {"diffuseTransmissionFactor": 0.3, "diffuseTransmissionColorFactor": COLOR, "diffuseTransmissionColorTexture": {"index": 0}}
        kept = [((t / 255 + 0.055) / 1.055)**2.4 for t in TEXEL]  # sRGB
        material = base(0, 1, specular={"specularFactor": 0}, diffuse_transmission=through)
        # The others are there for what scene() gives to the last four.
        self.shown([(material, [IRRADIANCE * 0.3 * c * k / math.pi for c, k in zip(COLOR, kept)])] + 4 * [(material, [])], math.pi - ANGLE)

    def test_gloss_at_a_grazing_angle(self):
        """The camera sees the mirror image of the light, so the reflectance is half of f90."""
        angle, alpha, specular = 1.2, 0.25, 0.8
        gltf = quad(base(0, 0.5, specular={"specularFactor": specular}))
        turned = lambda sign: [0, sign * math.sin(angle / 2), 0, math.cos(angle / 2)]
        gltf["nodes"] = [gltf["nodes"][0], {"camera": 0, "translation": [-5 * math.sin(angle), 0, 5 * math.cos(angle)], "rotation": turned(-1)},
                         {"rotation": turned(1), "extensions": {"KHR_lights_punctual": {"light": 0}}}]
        gltf["scenes"] = [{"nodes": [0, 1, 2]}]
        gltf["cameras"] = [{"type": "orthographic", "orthographic": {"xmag": 0.2, "ymag": 0.2, "zfar": 10, "znear": 0.1}}]
        gltf["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 2}]}}
        path = self.written("grazing.gltf", {key: value for key, value in gltf.items() if value})
        pixel = self.picture(str(path.with_suffix("")), "x.pfm", "--resolution", "8,8", "--spp", 1, "--bounces", 0, "--disable", "energy-compensation")[4][4]
        cosine, f0 = math.cos(angle), 0.04 * specular
        smith = (math.sqrt(1 + alpha**2 * math.tan(angle)**2) - 1) / 2
        lobe = 1 / (math.pi * alpha**2) / ((1 + 2 * smith) * 4 * cosine)
        self.assertAlmostEqual(pixel[0] / (2 * lobe * (f0 + (specular - f0) * (1 - cosine)**5)), 1, delta=3e-4)


if __name__ == "__main__":
    main()
