# SPDX-License-Identifier: MIT
"""glTF materials that Mitsuba lacks, as BSDFs written from the specification: appendix B of glTF 2.0, KHR_materials_specular, _ior and
_transmission. Only the GGX distribution itself is Mitsuba's."""

import drjit as dr
import mitsuba as mi
import numpy as np


# Facets can send light below the surface; that share is lost (single scattering). A blend asks its parts for the value of a direction that any
# of them has drawn, so a lost one must not be the direction of another part.
NOWHERE = mi.Vector3f(0)


def correlated_masking(facets, outgoing, incoming, half):
    """Returns G of appendix B (height-correlated Smith) from the G1 = 1 / (1 + Lambda) of each direction."""
    lambdas = 1 / facets.smith_g1(outgoing, half) + 1 / facets.smith_g1(incoming, half) - 1
    return dr.select((dr.dot(outgoing, half) > 0) & (dr.dot(incoming, half) > 0), 1 / lambdas, 0)


def specular_brdf(facets, outgoing, incoming):
    half = dr.normalize(outgoing + incoming)
    masked = facets.eval(half) * correlated_masking(facets, outgoing, incoming, half)
    return masked / (4 * mi.Frame3f.cos_theta(outgoing) * mi.Frame3f.cos_theta(incoming))


def specular_density(facets, outgoing, incoming):
    half = dr.normalize(outgoing + incoming)
    return facets.pdf(outgoing, half) / (4 * dr.dot(outgoing, half))


def schlick(f0, v_dot_h):
    return f0 + (1 - f0) * (1 - dr.abs(v_dot_h)) ** 5


def mixed(a, b, t):
    return a * (1 - t) + b * t


def single_scattering_albedo(alpha, cosines, steps=1024):
    """E(o) of a white metal by the midpoint rule over half vectors, whose D cos is uniform in (u, phi / 2 pi)."""
    u, turn = np.meshgrid(*[(np.arange(steps) + 0.5) / steps] * 2)
    tangent = alpha * np.sqrt(u / (1 - u))
    hz = 1 / np.sqrt(1 + tangent ** 2)
    hx, result = hz * tangent * np.cos(np.pi * turn), []

    def smith_lambda(cosine):
        return (np.sqrt(1 + alpha ** 2 * (1 / cosine ** 2 - 1)) - 1) / 2

    for oz in cosines:
        oh = np.sqrt(1 - oz ** 2) * hx + oz * hz
        iz = 2 * oh * hz - oz
        lit = (oh > 0) & (iz > 0)
        g = 1 / (1 + smith_lambda(oz) + smith_lambda(np.where(lit, iz, 1)))
        result.append(np.mean(np.where(lit, g * oh / (oz * hz), 0)))
    return np.array(result)


class Compensation:
    """Kulla and Conty's lobe (2017): what single scattering loses, (1 - E(o)) (1 - E(i)) / (pi (1 - E average)), coloured by what the facets
    absorb in between."""

    def __init__(self, alpha, size=128):
        cosines = (np.arange(size) + 0.5) / size
        albedo = single_scattering_albedo(alpha, cosines)
        self.average = float(np.sum(2 * albedo * cosines) / size)
        self.loss = mi.Float((1 - albedo).astype(np.float32))
        self.size = size

    def loss_at(self, cosine):
        place = dr.clip(cosine * self.size - 0.5, 0, self.size - 1.001)
        below = mi.UInt32(place)
        return mixed(dr.gather(mi.Float, self.loss, below), dr.gather(mi.Float, self.loss, below + 1), place - mi.Float(below))

    def value(self, f0, outgoing_z, incoming_z):
        mean_fresnel = f0 + (1 - f0) / 21  # mean of Schlick's reflectance over the hemisphere
        color = dr.square(mean_fresnel) * self.average / (1 - mean_fresnel * (1 - self.average))
        return color * self.loss_at(outgoing_z) * self.loss_at(incoming_z) / (dr.pi * (1 - self.average))


class GltfSurface(mi.BSDF):
    """The BSDF mix(dielectric, metal, metallic). The properties are base_color (colour or texture), metallic,
    roughness, ior, specular, specular_color, metallic_roughness_map, specular_map and specular_color_map (textures,
    each optional), compensated."""

    def __init__(self, properties):
        super().__init__(properties)
        color = properties["base_color"]
        self.base_color = (lambda si, active: mi.Color3f(color)) if isinstance(color, mi.ScalarColor3d) else color.eval
        self.map = properties.get("metallic_roughness_map", None)
        self.specular_map = properties.get("specular_map", None)
        self.specular_color_map = properties.get("specular_color_map", None)
        self.metallic, self.roughness = properties["metallic"], properties["roughness"]
        self.ior, self.specular = properties["ior"], properties["specular"]
        self.specular_color = mi.Color3f(properties["specular_color"])
        self.pure_metal = self.metallic == 1 and self.map is None
        self.compensation = None
        if properties.get("compensated", False):
            assert self.pure_metal
            self.compensation = Compensation(self.roughness ** 2)
        flags = mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.DiffuseReflection | mi.BSDFFlags.FrontSide
        self.m_components, self.m_flags = [flags], flags
        self.specular_chance = 1.0 if self.pure_metal and not self.compensation else 0.5

    def parts(self, si, active):
        """Metallic and the facets of a point: in the map, roughness is green, metallic blue."""
        metallic, roughness = mi.Float(self.metallic), mi.Float(self.roughness)
        if self.map is not None:
            texel = self.map.eval(si, active)
            metallic, roughness = metallic * texel.z, roughness * texel.y
        return metallic, mi.MicrofacetDistribution(mi.MicrofacetType.GGX, dr.square(roughness), True)

    def specular_parts(self, si, active):
        specular, color = mi.Float(self.specular), mi.Color3f(self.specular_color)
        if self.specular_map is not None:
            specular *= self.specular_map.eval(si, active).x
        if self.specular_color_map is not None:
            color *= self.specular_color_map.eval(si, active)
        return specular, color

    def value(self, si, metallic, facets, incoming, active):
        base, outgoing = self.base_color(si, active), si.wi
        v_dot_h = dr.dot(outgoing, dr.normalize(outgoing + incoming))
        layer = specular_brdf(facets, outgoing, incoming)
        metal = layer * schlick(base, v_dot_h)
        if self.compensation:
            metal += self.compensation.value(base, mi.Frame3f.cos_theta(outgoing), mi.Frame3f.cos_theta(incoming))
        if self.pure_metal:
            return metal
        specular, color = self.specular_parts(si, active)
        fresnel = schlick(dr.minimum(((1 - self.ior) / (1 + self.ior)) ** 2 * color, 1), v_dot_h)
        dielectric = (1 - specular * dr.max(fresnel)) * base / dr.pi + specular * fresnel * layer
        return mixed(dielectric, metal, metallic)

    def eval_pdf(self, context, si, incoming, active=True):
        outgoing, cosine = si.wi, mi.Frame3f.cos_theta(incoming)
        active = mi.Mask(active) & (mi.Frame3f.cos_theta(outgoing) > 0) & (cosine > 0)
        metallic, facets = self.parts(si, active)
        value = self.value(si, metallic, facets, incoming, active) * cosine
        density = mixed(cosine / dr.pi, specular_density(facets, outgoing, incoming), self.specular_chance)
        return dr.select(active, value, 0), dr.select(active, density, 0)

    def eval(self, context, si, incoming, active=True):
        return self.eval_pdf(context, si, incoming, active)[0]

    def pdf(self, context, si, incoming, active=True):
        return self.eval_pdf(context, si, incoming, active)[1]

    def sample(self, context, si, choice, pair, active=True):
        facets = self.parts(si, active)[1]
        half, _ = facets.sample(si.wi, pair)
        mirrored = 2 * dr.dot(si.wi, half) * half - si.wi
        bs = dr.zeros(mi.BSDFSample3f)
        bs.wo = dr.select(choice < self.specular_chance, mirrored, mi.warp.square_to_cosine_hemisphere(pair))
        bs.wo = dr.select(bs.wo.z > 0, bs.wo, NOWHERE)
        value, bs.pdf = self.eval_pdf(context, si, bs.wo, active)
        bs.eta, bs.sampled_component = 1.0, mi.UInt32(0)
        bs.sampled_type = mi.UInt32(+(mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.DiffuseReflection))
        kept = active & (bs.pdf > 0)
        return bs, dr.select(kept, value / bs.pdf, 0)


class ThinRoughGlass(mi.BSDF):
    """KHR_materials_transmission with transmission 1: the transmitted lobe is the reflected one on the other side of
    the wall. The reflectance is that of two parallel interfaces, see docs/design/surfaces.md. Properties: tint,
    roughness, ior."""

    def __init__(self, properties):
        super().__init__(properties)
        self.tint = mi.Color3f(properties["tint"])
        self.ior = properties["ior"]
        self.alpha = properties["roughness"] ** 2
        sides = mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
        self.m_components = [mi.BSDFFlags.GlossyReflection | sides, mi.BSDFFlags.GlossyTransmission | sides]
        self.m_flags = self.m_components[0] | self.m_components[1]

    def facets(self):
        return mi.MicrofacetDistribution(mi.MicrofacetType.GGX, self.alpha, True)

    def reflectance(self, v_dot_h):
        single = mi.fresnel(dr.abs(v_dot_h), self.ior)[0]
        return 2 * single / (1 + single)

    def eval_pdf(self, context, si, incoming, active=True):
        # H_T of the extension: the half vector after the light is mirrored to the viewer's side.
        transmitted = incoming.z * si.wi.z < 0
        outgoing = mi.Vector3f(si.wi.x, si.wi.y, dr.abs(si.wi.z))
        image = mi.Vector3f(incoming.x, incoming.y, dr.abs(incoming.z))
        facets = self.facets()
        share = self.reflectance(dr.dot(outgoing, dr.normalize(outgoing + image)))
        share = dr.select(transmitted, 1 - share, share)
        tint = dr.select(transmitted, self.tint, mi.Color3f(1))
        value = tint * (share * specular_brdf(facets, outgoing, image) * image.z)
        density = share * specular_density(facets, outgoing, image)
        active = mi.Mask(active) & (outgoing.z > 0) & (image.z > 0)
        return dr.select(active, value, 0), dr.select(active, density, 0)

    def eval(self, context, si, incoming, active=True):
        return self.eval_pdf(context, si, incoming, active)[0]

    def pdf(self, context, si, incoming, active=True):
        return self.eval_pdf(context, si, incoming, active)[1]

    def sample(self, context, si, choice, pair, active=True):
        side = dr.sign(si.wi.z)
        outgoing = mi.Vector3f(si.wi.x, si.wi.y, dr.abs(si.wi.z))
        half, _ = self.facets().sample(outgoing, pair)
        v_dot_h = dr.dot(outgoing, half)
        image = 2 * v_dot_h * half - outgoing
        transmitted = choice >= self.reflectance(v_dot_h)
        bs = dr.zeros(mi.BSDFSample3f)
        bs.wo = mi.Vector3f(image.x, image.y, dr.select(transmitted, -side, side) * image.z)
        bs.wo = dr.select(image.z > 0, bs.wo, NOWHERE)
        value, bs.pdf = self.eval_pdf(context, si, bs.wo, active)
        bs.eta, bs.sampled_component = 1.0, dr.select(transmitted, mi.UInt32(1), mi.UInt32(0))
        bs.sampled_type = dr.select(transmitted, mi.UInt32(+mi.BSDFFlags.GlossyTransmission), mi.UInt32(+mi.BSDFFlags.GlossyReflection))
        kept = active & (bs.pdf > 0)
        return bs, dr.select(kept, value / bs.pdf, 0)


mi.register_bsdf("gltf", GltfSurface)
mi.register_bsdf("thin-rough-glass", ThinRoughGlass)
