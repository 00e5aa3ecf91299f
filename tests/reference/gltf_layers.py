# SPDX-License-Identifier: MIT
"""Material extensions of GltfSurface, written from their ratified texts: KHR_materials_clearcoat, _sheen, _anisotropy,
_iridescence and _diffuse_transmission. No maps; the clearcoat's normal is the surface's."""

import drjit as dr
import mitsuba as mi
import numpy as np

from gltf_bsdf import NOWHERE, mixed, schlick, specular_brdf, specular_density


class Sheen:
    """The Charlie lobe with alpha = sheenRoughness^2, and its albedo E by quadrature over the hemisphere."""

    def __init__(self, roughness, size=512, steps=256):
        self.alpha, self.size = roughness ** 2, size
        # Both angles by the midpoint rule; nodes and steps are even in the root of the cosine, as the lobe is steep at the horizon.
        cosines = np.maximum(np.arange(size) / (size - 1), 1e-2) ** 2
        root, turn = np.meshgrid(*[(np.arange(steps) + 0.5) / steps] * 2)
        iz, phi = root ** 2, np.pi * turn
        albedo = []
        for oz in cosines:
            x = np.sqrt(1 - oz ** 2) + np.sqrt(1 - iz ** 2) * np.cos(phi)
            y = np.sqrt(1 - iz ** 2) * np.sin(phi)
            sine2 = (x ** 2 + y ** 2) / (x ** 2 + y ** 2 + (oz + iz) ** 2)
            value = self.distribution(sine2) / (4 * oz * (1 + self.smith(oz, np) + self.smith(iz, np)))
            albedo.append(np.mean(value * 2 * root) * 2 * np.pi)
        assert max(albedo) <= 1, "fragtrace divides lobes that give out more than they get"
        self.albedo = mi.Float(np.array(albedo, np.float32))

    def distribution(self, sine2):
        return (2 + 1 / self.alpha) * sine2 ** (0.5 / self.alpha) / (2 * np.pi)

    def fit(self, x):
        t = (1 - self.alpha) ** 2
        a, b, c = mixed(21.5473, 25.3245, t), mixed(3.82987, 3.32435, t), mixed(0.19823, 0.16801, t)
        return a / (1 + b * x ** c) + mixed(-1.97760, -1.27393, t) * x + mixed(-4.32054, -4.85967, t)

    def smith(self, cosine, library=dr):
        """Returns Smith's Lambda by the fit of Estevez and Kulla. `library` is numpy or drjit."""
        choose = np.where if library is np else dr.select
        low, high = library.minimum(cosine, 0.5), library.maximum(cosine, 0.5)
        return choose(cosine < 0.5, library.exp(self.fit(low)), library.exp(2 * self.fit(0.5) - self.fit(1 - high)))

    def brdf(self, outgoing, incoming):
        half = dr.normalize(outgoing + incoming)
        visibility = 1 / ((1 + self.smith(outgoing.z) + self.smith(incoming.z)) * 4 * outgoing.z * incoming.z)
        return self.distribution(dr.maximum(1 - dr.square(half.z), 0)) * visibility

    def share(self, cosine):
        place = dr.clip(dr.sqrt(dr.abs(cosine)) * (self.size - 1), 0, self.size - 1.001)
        below = mi.UInt32(place)
        return mixed(dr.gather(mi.Float, self.albedo, below), dr.gather(mi.Float, self.albedo, below + 1), place - mi.Float(below))


class Film:
    """The reflectance of a thin film in air, from the text's own steps."""

    MATRIX = ((3.2404542, -1.5371385, -0.4985314), (-0.9692660, 1.8760108, 0.0415560), (0.0556434, -0.2040259, 1.0572252))

    def __init__(self, index, thickness):
        self.index, self.thickness = index, thickness

    @staticmethod
    def sensitivity(path, shift):
        phase = 2 * dr.pi * path * 1e-9
        values, places, variances = (5.4856e-13, 4.4201e-13, 5.2481e-13), (1.6810e6, 1.7953e6, 2.2084e6), (4.3278e9, 9.3046e9, 6.6121e9)
        xyz = [float(v * np.sqrt(2 * np.pi * s)) * dr.cos(p * phase + shift[k]) * dr.exp(-dr.square(phase) * s)
               for k, (v, p, s) in enumerate(zip(values, places, variances))]
        xyz[0] += float(9.7470e-14 * np.sqrt(2 * np.pi * 4.5282e9)) * dr.cos(2.2399e6 * phase + shift[0]) * dr.exp(-4.5282e9 * dr.square(phase))
        return mi.Color3f(*[sum(m * x for m, x in zip(row, xyz)) / 1.0685e-7 for row in Film.MATRIX])

    def reflectance(self, f0, cosine):
        inside = dr.sqrt(1 - (1 - dr.square(cosine)) / self.index ** 2)
        r12 = schlick(((self.index - 1) / (self.index + 1)) ** 2, cosine)
        root = dr.sqrt(f0 + 1e-4)
        base = (1 + root) / (1 - root)
        r23 = schlick(dr.square((base - self.index) / (base + self.index)), inside)
        shift = dr.pi + dr.select(base < self.index, mi.Color3f(dr.pi), mi.Color3f(0))
        r123 = dr.clip(r12 * r23, 1e-5, 0.9999)
        rs = dr.square(1 - r12) * r23 / (1 - r123)
        path = 2 * self.index * self.thickness * inside
        result, factor = r12 + rs, rs - (1 - r12)
        for m in (1, 2):
            factor *= dr.sqrt(r123)
            result += factor * 2 * self.sensitivity(m * path, m * shift)
        return dr.clip(result, 0, 1)


class LayeredSurface(mi.BSDF):
    """Properties, all numbers or colours: base_color, metallic, roughness, ior; coat, coat_roughness; sheen_color, sheen_roughness; anisotropy,
    turn (of the stretched direction against dp_du, radians); film, film_index, film_thickness; through, through_color."""

    def __init__(self, properties):
        super().__init__(properties)
        color = lambda name: mi.Color3f(properties[name])
        self.base_color, self.sheen_color, self.through_color = color("base_color"), color("sheen_color"), color("through_color")
        self.metallic, self.through, self.coat = properties["metallic"], properties["through"], properties["coat"]
        self.f0 = ((1 - properties["ior"]) / (1 + properties["ior"])) ** 2
        alpha = properties["roughness"] ** 2
        self.facets = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, mixed(alpha, 1, properties["anisotropy"] ** 2), alpha, True)
        self.turn = properties["turn"]
        self.coat_facets = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, properties["coat_roughness"] ** 2, True)
        roughness = properties["sheen_roughness"]
        self.sheen = Sheen(roughness) if max(properties["sheen_color"]) > 0 else None
        self.film_weight, self.film = properties["film"], Film(properties["film_index"], properties["film_thickness"])
        sides = mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
        self.m_components = [mi.BSDFFlags.GlossyReflection | sides, mi.BSDFFlags.DiffuseTransmission | sides]
        self.m_flags = self.m_components[0] | self.m_components[1]

    def turned(self, v, angle):
        """Turns a vector from the shading frame to that of the facets, or back by the negative angle."""
        c, s = float(np.cos(angle)), float(np.sin(angle))
        return mi.Vector3f(c * v.x + s * v.y, c * v.y - s * v.x, v.z)

    def fresnel(self, f0, cosine):
        bare = schlick(f0, cosine)
        return mixed(bare, self.film.reflectance(f0, cosine), self.film_weight) if self.film_weight > 0 else bare

    def base(self, outgoing, image, transmitted):
        """Returns the BSDF of the material below sheen and clearcoat. `image` is the incoming direction, mirrored to
        the viewer's side if it is on the other."""
        layer = specular_brdf(self.facets, self.turned(outgoing, self.turn), self.turned(image, self.turn))
        cosine = dr.dot(outgoing, dr.normalize(outgoing + image))
        dielectric = self.fresnel(mi.Color3f(self.f0), cosine)
        diffuse = dr.select(transmitted, self.through * self.through_color, (1 - self.through) * self.base_color) / dr.pi
        reflected = mixed(dielectric, self.fresnel(self.base_color, cosine), self.metallic) * layer
        return (1 - self.metallic) * (1 - dr.max(dielectric)) * diffuse + dr.select(transmitted, 0, reflected)

    def value(self, outgoing, image, transmitted):
        result = self.base(outgoing, image, transmitted)
        if self.sheen:
            share = dr.maximum(self.sheen.share(outgoing.z), self.sheen.share(image.z))
            result *= 1 - dr.max(self.sheen_color) * share
            result += dr.select(transmitted, 0, self.sheen_color * self.sheen.brdf(outgoing, image))
        coat = dr.select(transmitted, 0, specular_brdf(self.coat_facets, outgoing, image))
        return mixed(result, mi.Color3f(coat), self.coat * schlick(0.04, outgoing.z))

    def density(self, outgoing, image, transmitted):
        """Half of the draws are cosine-weighted (on both sides alike, if light passes), a quarter facets, a quarter those of the clearcoat."""
        facets = specular_density(self.facets, self.turned(outgoing, self.turn), self.turned(image, self.turn))
        specular = facets + specular_density(self.coat_facets, outgoing, image)
        return image.z / dr.pi * (0.25 if self.through > 0 else 0.5) + dr.select(transmitted, 0, specular) / 4

    def eval_pdf(self, context, si, incoming, active=True):
        transmitted = incoming.z * si.wi.z < 0
        outgoing = mi.Vector3f(si.wi.x, si.wi.y, dr.abs(si.wi.z))
        image = mi.Vector3f(incoming.x, incoming.y, dr.abs(incoming.z))
        active = mi.Mask(active) & (outgoing.z > 0) & (image.z > 0)
        value = self.value(outgoing, image, transmitted) * image.z
        return dr.select(active, value, 0), dr.select(active, self.density(outgoing, image, transmitted), 0)

    def eval(self, context, si, incoming, active=True):
        return self.eval_pdf(context, si, incoming, active)[0]

    def pdf(self, context, si, incoming, active=True):
        return self.eval_pdf(context, si, incoming, active)[1]

    def sample(self, context, si, choice, pair, active=True):
        side = dr.sign(si.wi.z)
        outgoing = mi.Vector3f(si.wi.x, si.wi.y, dr.abs(si.wi.z))
        turned = self.turned(outgoing, self.turn)
        half = self.facets.sample(turned, pair)[0]
        stretched = self.turned(2 * dr.dot(turned, half) * half - turned, -self.turn)
        half = self.coat_facets.sample(outgoing, pair)[0]
        coated = 2 * dr.dot(outgoing, half) * half - outgoing
        direction = dr.select(choice < 0.75, stretched, coated)
        direction = dr.select(direction.z > 0, direction, NOWHERE)
        diffuse = mi.warp.square_to_cosine_hemisphere(pair)
        if self.through > 0:
            diffuse.z = dr.select(choice < 0.25, -diffuse.z, diffuse.z)
        direction = dr.select(choice < 0.5, diffuse, direction)
        bs = dr.zeros(mi.BSDFSample3f)
        bs.wo = mi.Vector3f(direction.x, direction.y, side * direction.z)
        value, bs.pdf = self.eval_pdf(context, si, bs.wo, active)
        transmitted = bs.wo.z * si.wi.z < 0
        bs.eta, bs.sampled_component = 1.0, dr.select(transmitted, mi.UInt32(1), mi.UInt32(0))
        bs.sampled_type = dr.select(transmitted, mi.UInt32(+mi.BSDFFlags.DiffuseTransmission), mi.UInt32(+mi.BSDFFlags.GlossyReflection))
        kept = active & (bs.pdf > 0)
        return bs, dr.select(kept, value / bs.pdf, 0)


mi.register_bsdf("layered", LayeredSurface)
