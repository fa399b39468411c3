"""Loads scenes of glTF into the path tracer Mitsuba 3.9.1, with a BSDF that has the formulas of glTF 2.0, appendix B.

Mitsuba's own materials have other formulas. This file shares no code with catoptric's shaders, so that pictures of both can
be compared. Skins, colours of vertices and second texture coordinates are refused, and lights and lamps are left out.
"""

import dataclasses
import math

import drjit as dr
import mitsuba as mi
import numpy as np

import pose

mi.set_variant("llvm_ad_rgb")

SMALLEST_ALPHA = 1e-3 # narrower lobes are drawn with this width
ALBEDO_EDGE = 64      # edge of the table of lobe albedos
WRAPS = {33071: dr.WrapMode.Clamp, 33648: dr.WrapMode.Mirror, 10497: dr.WrapMode.Repeat}
DTYPES = {5120: "i1", 5121: "u1", 5122: "i2", 5123: "u2", 5125: "u4", 5126: "f4"}
EXTENSIONS = {"KHR_materials_ior", "KHR_materials_specular", "KHR_materials_transmission", "KHR_texture_transform",
              "KHR_materials_emissive_strength", "KHR_lights_punctual"}


@dataclasses.dataclass
class Shading:
    """Choices that glTF leaves open or that renderers make differently."""

    # What the diffuse part gets: the "rest" that the lobe's albedo leaves, or "khronos": what the Fresnel reflectance of the
    # facet half-way between both directions leaves, as in appendix B.
    diffuse: str = "rest"
    shadowing: str = "correlated" # Smith's shadowing and masking: "correlated", or "separable" as in appendix B
    tests_facets: bool = True     # whether the diffuse part gets no light from below the facet
    takes_plain_bsdfs: bool = False # whether Lambertian surfaces and sharp mirrors get Mitsuba's own BSDFs


class Texture:
    """Texture of glTF: texel (i, j) has its centre at ((i + .5) / width, (j + .5) / height), v downwards."""

    def __init__(self, texels, sampler, transform):
        wraps = [WRAPS[sampler.get(key, 10497)] for key in ("wrapS", "wrapT")]
        if wraps[0] != wraps[1]:
            raise pose.SceneError("wanted one wrap mode for both axes of a texture")
        nearest = sampler.get("magFilter", 9729) == 9728
        filter_mode = dr.FilterMode.Nearest if nearest else dr.FilterMode.Linear
        self.map = mi.Texture2f(mi.TensorXf(texels), wrap_mode=wraps[0], filter_mode=filter_mode)
        offset, scale, turn = transform.get("offset", [0, 0]), transform.get("scale", [1, 1]), transform.get("rotation", 0)
        self.rows = [[math.cos(turn) * scale[0], math.sin(turn) * scale[1], offset[0]],
                     [-math.sin(turn) * scale[0], math.cos(turn) * scale[1], offset[1]]]

    def read(self, uv):
        return self.map.eval(mi.Point2f(*(row[0] * uv.x + row[1] * uv.y + row[2] for row in self.rows)))


class Material:
    """Material of glTF, with the reflectances f0 and f90 of its dielectric part seen head-on and at grazing angle."""

    def __init__(self, name="material"):
        self.name = name
        self.colour, self.alpha, self.emission = [1.0, 1.0, 1.0], 1.0, [0.0, 0.0, 0.0]
        self.metallic = self.roughness = 1.0
        self.f0, self.f90 = [0.04] * 3, 1.0
        self.two_sided, self.cutoff, self.blended = False, None, False
        self.transmission, self.ior = False, 1.5
        self.textures, self.normal_scale = {}, 1.0


NUMBERED = [] # material, shading and table of albedos of each BSDF, because a BSDF takes only numbers


def smith_length(alpha, cosine):
    """Returns the square root in Smith's shadowing of GGX, for a direction at this cosine to the normal."""
    return dr.sqrt(alpha * alpha + (1 - alpha * alpha) * cosine * cosine)


def visibility(shadowing, alpha, to_eye, to_light):
    """Returns G / (4 cos cos)."""
    if shadowing == "separable":
        return dr.rcp((to_eye + smith_length(alpha, to_eye)) * (to_light + smith_length(alpha, to_light)))
    return .5 * dr.rcp(to_light * smith_length(alpha, to_eye) + to_eye * smith_length(alpha, to_light))


def density(alpha, cosine):
    """Returns the density D of microfacet normals."""
    a2 = alpha * alpha
    return a2 * dr.rcp(dr.pi * dr.square(cosine * cosine * (a2 - 1) + 1))


def draw_facet(alpha, wi, sample):
    """Draws a microfacet's normal among those visible from wi (Heitz, "Sampling the GGX Distribution of Visible Normals",
    2018)."""
    stretched = dr.normalize(mi.Vector3f(alpha * wi.x, alpha * wi.y, wi.z))
    size2 = stretched.x * stretched.x + stretched.y * stretched.y
    across = mi.Vector3f(-stretched.y, stretched.x, 0) * dr.rsqrt(dr.maximum(size2, 1e-12))
    side = dr.select(size2 > 1e-12, across, mi.Vector3f(1, 0, 0))
    other = dr.cross(stretched, side)
    radius, angle = dr.sqrt(sample.x), 2 * dr.pi * sample.y
    x, y, share = radius * dr.cos(angle), radius * dr.sin(angle), .5 * (1 + stretched.z)
    y = (1 - share) * dr.sqrt(dr.maximum(0, 1 - x * x)) + share * y
    n = x * side + y * other + dr.sqrt(dr.maximum(0, 1 - x * x - y * y)) * stretched
    return dr.normalize(mi.Vector3f(alpha * n.x, alpha * n.y, dr.maximum(1e-6, n.z)))


def make_albedo_table(shadowing):
    """Returns a table of the albedo of lobes as f0 times its first channel plus f90 times its second, over the square root
    of the cosine of the viewer and the roughness."""
    edge, draws = ALBEDO_EDGE, 4096
    lane = dr.arange(mi.UInt32, edge * edge * draws)
    cell = lane // draws
    root, rough = (mi.Float(cell % edge) + .5) / edge, (mi.Float(cell // edge) + .5) / edge
    alpha, cosine = dr.maximum(SMALLEST_ALPHA, rough * rough), root * root
    sampler = mi.load_dict({"type": "independent"})
    sampler.seed(1, edge * edge * draws)
    wi = mi.Vector3f(dr.sqrt(1 - cosine * cosine), 0, cosine)
    h = draw_facet(alpha, wi, sampler.next_2d())
    wo = mi.reflect(wi, h)
    # The weight of a visible normal is G / G1.
    unblocked = visibility(shadowing, alpha, wi.z, dr.maximum(wo.z, 1e-9)) * 2 * wo.z
    weight = dr.select(wo.z > 0, unblocked * (wi.z + smith_length(alpha, wi.z)), 0)
    grazing = (1 - dr.dot(wi, h)) ** 5
    means = [dr.block_sum(part * weight, draws) / draws for part in (1 - grazing, grazing)]
    table = np.stack([np.array(mean).reshape(edge, edge) for mean in means], -1)
    return mi.Texture2f(mi.TensorXf(table.astype(np.float32)), wrap_mode=dr.WrapMode.Clamp)


def greatest(colour):
    return dr.maximum(colour.x, dr.maximum(colour.y, colour.z))


class GltfBsdf(mi.BSDF):
    """Material of glTF 2.0. Component 0 is its diffuse part, and component 1 its lobe."""

    def __init__(self, props):
        super().__init__(props)
        self.material, self.shading, self.albedo = NUMBERED[int(props["number"])]
        both = mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
        self.m_components = [kind | both for kind in (mi.BSDFFlags.DiffuseReflection, mi.BSDFFlags.GlossyReflection, mi.BSDFFlags.Null)]
        self.m_flags = self.m_components[0] | self.m_components[1] | self.m_components[2]

    def read(self, name, si, count):
        texture = self.material.textures.get(name)
        return texture.read(si.uv)[:count] if texture else [mi.Float(1)] * count

    def shade(self, si):
        """Evaluates material and shading frame at a point."""
        m, s = self.material, type("Shade", (), {})()
        out = si.to_world(si.wi)
        red, green, blue, alpha = self.read("colour", si, 4)
        s.is_back = dr.dot(si.n, out) < 0
        s.opacity = mi.Float(1)
        if m.cutoff is not None:
            s.opacity = dr.select(alpha * m.alpha >= m.cutoff, 1, 0)
        elif m.blended:
            s.opacity = dr.clip(alpha * m.alpha, 0, 1)
        if not m.two_sided:
            s.opacity = dr.select(s.is_back, 0, s.opacity)
        s.colour = mi.Color3f(m.colour) * mi.Color3f(red, green, blue)
        _, rough, metal = self.read("rough", si, 3)
        metallic, roughness = m.metallic * metal, m.roughness * rough
        s.alpha = dr.maximum(SMALLEST_ALPHA, roughness * roughness)
        s.dielectric_f0 = mi.Color3f(m.f0)
        s.f0 = dr.lerp(s.dielectric_f0, s.colour, metallic)
        s.f90 = dr.lerp(mi.Color3f(m.f90), 1, metallic)
        normal = mi.Vector3f(si.sh_frame.n)
        if "normal" in m.textures:
            x, y, z = (2 * value - 1 for value in self.read("normal", si, 3))
            tangent = dr.normalize(si.dp_du - normal * dr.dot(si.dp_du, normal))
            bitangent = dr.cross(normal, tangent)
            bitangent = dr.mulsign(bitangent, -dr.dot(bitangent, si.dp_dv)) # y grows against v
            bent = dr.normalize(x * m.normal_scale * tangent + y * m.normal_scale * bitangent + z * normal)
            normal = dr.select(dr.dot(si.dp_du, si.dp_du) > 0, bent, normal)
        if m.two_sided: # the normal turns to the side of the facet that is seen
            normal = dr.select(s.is_back, -normal, normal)
        s.facet = dr.select(s.is_back, -si.n, si.n)
        s.frame = mi.Frame3f(normal)
        s.wi = s.frame.to_local(out)
        a, b = self.albedo.eval(mi.Point2f(dr.sqrt(dr.clip(dr.abs(s.wi.z), 0, 1)), roughness))
        s.lobe_albedo = s.f0 * a + s.f90 * b
        s.base = s.colour * (1 - metallic)
        s.lobe_share = greatest(s.lobe_albedo) / dr.maximum(1e-6, greatest(s.lobe_albedo) + greatest(s.base * (1 - s.lobe_albedo)))
        s.lobe_share = dr.select(s.wi.z > 0, s.lobe_share, 0)
        return s

    def evaluate(self, s, ctx, world):
        """Returns the BSDF times the cosine, and the density with which sample() draws the direction."""
        wo = s.frame.to_local(world)
        is_above_facet = dr.dot(world, s.facet) > 0
        is_lit = (wo.z > 0) & (is_above_facet | (not self.shading.tests_facets))
        h = dr.normalize(s.wi + wo)
        facing = dr.abs(dr.dot(s.wi, h))
        grazing = (1 - facing) ** 5
        is_reflected = (wo.z > 0) & (s.wi.z > 0) & is_above_facet
        d, wi_z = density(s.alpha, h.z), dr.maximum(s.wi.z, 1e-9)
        shape = d * visibility(self.shading.shadowing, s.alpha, wi_z, dr.maximum(wo.z, 1e-9))
        lobe = (s.f0 + (s.f90 - s.f0) * grazing) * shape * wo.z
        if self.shading.diffuse == "khronos":
            rest = 1 - (s.dielectric_f0 + (self.material.f90 - s.dielectric_f0) * grazing)
        else:
            rest = 1 - s.lobe_albedo
        diffuse = s.base * rest * (wo.z / dr.pi)
        lobe_pdf = d * dr.rcp(2 * (wi_z + smith_length(s.alpha, wi_z)))
        share = self.share(s, ctx)
        value = mi.Color3f(0)
        if ctx.component != 1:
            value += dr.select(is_lit, diffuse, 0)
        if ctx.component != 0:
            value += dr.select(is_reflected, lobe, 0)
        return value, dr.select(is_lit | is_reflected, share * dr.select(s.wi.z > 0, lobe_pdf, 0) + (1 - share) * wo.z / dr.pi, 0)

    def share(self, s, ctx):
        return {0: mi.Float(0), 1: mi.Float(1)}.get(ctx.component, s.lobe_share)

    def sample(self, ctx, si, sample1, sample2, active=True):
        s, m, out = self.shade(si), self.material, si.to_world(si.wi)
        h = draw_facet(s.alpha, mi.Vector3f(s.wi.x, s.wi.y, dr.maximum(s.wi.z, 1e-6)), sample2)
        share = self.share(s, ctx)
        passes = sample1 >= s.opacity # first says whether the path passes the surface
        u = sample1 / dr.maximum(s.opacity, 1e-9)
        local = dr.select(u < share, mi.reflect(s.wi, h), mi.warp.square_to_cosine_hemisphere(sample2))
        world = s.frame.to_world(local)
        value, pdf = self.evaluate(s, ctx, world)
        weight = dr.select(pdf > 0, value / pdf, 0)
        if m.transmission: # a thin sheet, which rays pass straight
            reflectance = mi.fresnel(dr.abs(s.wi.z), m.ior)[0]
            is_reflected = u < reflectance
            world = dr.select(is_reflected, s.frame.to_world(mi.reflect(s.wi)), -out)
            weight = dr.select(is_reflected, mi.Color3f(1), s.colour)
        weight = dr.select(passes, mi.Color3f(1), weight)
        bs = mi.BSDFSample3f()
        bs.wo = si.to_local(dr.select(passes, -out, world))
        bs.pdf, bs.eta = pdf, 1
        is_null = passes | (mi.Bool(m.transmission) & (dr.dot(world, out) < -.9999))
        drawn_type = mi.BSDFFlags.DeltaReflection if m.transmission else mi.BSDFFlags.GlossyReflection
        bs.sampled_type = dr.select(is_null, mi.UInt32(+mi.BSDFFlags.Null), mi.UInt32(+drawn_type))
        bs.sampled_component = dr.select(is_null, mi.UInt32(2), 1)
        return bs, weight & active

    def eval_pdf(self, ctx, si, wo, active=True):
        value, pdf = self.evaluate(self.shade(si), ctx, si.to_world(wo))
        active &= not self.material.transmission
        return value & active, pdf & active

    def eval_null_transmission(self, si, active=True):
        s, m = self.shade(si), self.material
        share = mi.Color3f(1 - s.opacity)
        if m.transmission:
            share += s.opacity * s.colour * (1 - mi.fresnel(dr.abs(s.wi.z), m.ior)[0])
        return share & active

    def eval(self, ctx, si, wo, active=True):
        return self.eval_pdf(ctx, si, wo, active)[0]

    def pdf(self, ctx, si, wo, active=True):
        return self.eval_pdf(ctx, si, wo, active)[1]

    def to_string(self):
        return "GltfBsdf[]"


mi.register_bsdf("gltf", GltfBsdf)


class Loader:
    """Meshes of a .glb file of pose.py, one for each material, in the axes of the scene."""

    def __init__(self, gltf):
        self.gltf, self.images, self.parts = gltf, {}, {}
        document = gltf.document
        others = set(document.get("extensionsUsed", [])) - EXTENSIONS
        if others or document.get("skins"):
            raise pose.SceneError(f"wanted no skins and no extensions but {sorted(EXTENSIONS)}, found {sorted(others) or 'skins'}")
        for node in document["scenes"][document.get("scene", 0)]["nodes"]:
            self.add_node(node, np.eye(4))

    def array(self, index):
        """Returns the elements of an accessor, normalised numbers as floats."""
        accessor = self.gltf.document["accessors"][index]
        view = self.gltf.document["bufferViews"][accessor["bufferView"]]
        count, dtype = pose.COMPONENTS[accessor["type"]], np.dtype(DTYPES[accessor["componentType"]])
        stride = view.get("byteStride", count * dtype.itemsize)
        begin = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        found = np.ndarray((accessor["count"], count), dtype, self.gltf.data, begin, (stride, dtype.itemsize)).copy()
        return found / np.iinfo(dtype).max if accessor.get("normalized") else found

    def add_node(self, index, above):
        node = self.gltf.document["nodes"][index]
        if "matrix" in node:
            local = np.array(node["matrix"]).reshape(4, 4).T
        else:
            x, y, z, w = node.get("rotation", [0, 0, 0, 1])
            turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                             [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                             [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
            local = np.eye(4)
            local[:3, :3], local[:3, 3] = turn * np.array(node.get("scale", [1, 1, 1])), node.get("translation", [0, 0, 0])
        matrix = above @ local
        if "mesh" in node:
            for primitive in self.gltf.document["meshes"][node["mesh"]]["primitives"]:
                self.add_primitive(primitive, matrix)
        for child in node.get("children", []):
            self.add_node(child, matrix)

    def add_primitive(self, primitive, matrix):
        if primitive.get("mode", 4) != 4:
            return
        attributes = primitive["attributes"]
        corners = self.array(primitive["indices"])[:, 0] if "indices" in primitive else np.arange(
            self.gltf.document["accessors"][attributes["POSITION"]]["count"])
        points = self.array(attributes["POSITION"])[corners] @ matrix[:3, :3].T + matrix[:3, 3]
        if "NORMAL" in attributes:
            normals = self.array(attributes["NORMAL"])[corners] @ np.linalg.inv(matrix[:3, :3])
        else:
            sides = points.reshape(-1, 3, 3)
            normals = np.repeat(np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]), 3, 0)
        normals = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
        uv = self.array(attributes["TEXCOORD_0"])[corners] if "TEXCOORD_0" in attributes else np.zeros((len(corners), 2))
        if np.linalg.det(matrix[:3, :3]) < 0: # a mirrored object turns its triangles round
            points, normals, uv = (a.reshape(-1, 3, a.shape[1])[:, ::-1].reshape(a.shape) for a in (points, normals, uv))
        if "COLOR_0" in attributes and self.array(attributes["COLOR_0"]).min() < .999:
            raise pose.SceneError("wanted no colours of vertices but white")
        self.parts.setdefault(primitive.get("material"), []).append((points, normals, uv))

    def texels(self, index, is_srgb):
        """Returns the texels of an image, height x width x 4, in linear light."""
        key = index, is_srgb
        if key not in self.images:
            view = self.gltf.document["bufferViews"][self.gltf.document["images"][index]["bufferView"]]
            begin = view.get("byteOffset", 0)
            stream = mi.MemoryStream(view["byteLength"])
            stream.write(bytes(self.gltf.data[begin:begin + view["byteLength"]]))
            stream.seek(0)
            bytes_of = np.array(mi.Bitmap(stream).convert(mi.Bitmap.PixelFormat.RGBA, mi.Struct.Type.UInt8, srgb_gamma=True))
            found = bytes_of.astype(np.float32) / 255
            if is_srgb:
                colour = found[..., :3]
                found[..., :3] = np.where(colour <= .04045, colour / 12.92, ((colour + .055) / 1.055) ** 2.4)
            self.images[key] = found
        return self.images[key]

    def texture(self, info, is_srgb):
        if info.get("texCoord", 0):
            raise pose.SceneError("wanted textures of the first texture coordinates")
        texture = self.gltf.document["textures"][info["index"]]
        sampler = self.gltf.document["samplers"][texture["sampler"]] if "sampler" in texture else {}
        return Texture(self.texels(texture["source"], is_srgb), sampler, info.get("extensions", {}).get("KHR_texture_transform", {}))

    def material(self, index):
        found = self.gltf.document["materials"][index] if index is not None else {}
        m = Material(found.get("name", "material"))
        base, more = found.get("pbrMetallicRoughness", {}), found.get("extensions", {})
        *m.colour, m.alpha = base.get("baseColorFactor", [1, 1, 1, 1])
        m.metallic, m.roughness = base.get("metallicFactor", 1), base.get("roughnessFactor", 1)
        strength = more.get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)
        m.emission = [strength * value for value in found.get("emissiveFactor", [0, 0, 0])]
        m.ior = more.get("KHR_materials_ior", {}).get("ior", 1.5)
        specular = more.get("KHR_materials_specular", {})
        m.f90 = specular.get("specularFactor", 1)
        m.f0 = [min(((m.ior - 1) / (m.ior + 1)) ** 2 * tint, 1) * m.f90 for tint in specular.get("specularColorFactor", [1, 1, 1])]
        m.transmission = more.get("KHR_materials_transmission", {}).get("transmissionFactor", 0) >= .5
        m.two_sided, m.blended = found.get("doubleSided", False), found.get("alphaMode") == "BLEND"
        if found.get("alphaMode") == "MASK":
            m.cutoff = found.get("alphaCutoff", .5)
        for name, info, is_srgb in (("colour", base.get("baseColorTexture"), True),
                                    ("rough", base.get("metallicRoughnessTexture"), False),
                                    ("emission", found.get("emissiveTexture"), True),
                                    ("normal", found.get("normalTexture"), False)):
            if info:
                m.textures[name] = self.texture(info, is_srgb)
        m.normal_scale = found.get("normalTexture", {}).get("scale", 1)
        return m

    def all_parts(self):
        """Returns each material with the corners of its triangles: positions, normals and texture coordinates."""
        return [(self.material(index), *(np.concatenate(list(arrays)) for arrays in zip(*parts)))
                for index, parts in self.parts.items()]


def make_plain_bsdf(material):
    """Returns Mitsuba's own BSDF of a Lambertian surface or a sharp mirror, and None for other materials. It is black behind."""
    if material.transmission or material.blended or material.cutoff is not None or set(material.textures) - {"colour", "emission"}:
        return None
    if material.metallic == 0 and max(*material.f0, material.f90) == 0:
        bsdf = {"type": "diffuse", "reflectance": {"type": "rgb", "value": material.colour}}
        if "colour" in material.textures:
            map_ = material.textures["colour"].map
            if map_.wrap_mode() != dr.WrapMode.Repeat or material.textures["colour"].rows != [[1, 0, 0], [0, 1, 0]]:
                return None
            texels = np.array(map_.tensor())[..., :3] * np.array(material.colour, np.float32)
            kind = "nearest" if map_.filter_mode() == dr.FilterMode.Nearest else "bilinear"
            bsdf["reflectance"] = {"type": "bitmap", "bitmap": mi.Bitmap(np.ascontiguousarray(texels, np.float32)), "raw": True,
                                   "filter_type": kind}
    elif material.metallic == 1 and material.roughness == 0 and not material.textures:
        bsdf = {"type": "conductor", "material": "none", "specular_reflectance": {"type": "rgb", "value": material.colour}}
    else:
        return None
    return mi.load_dict({"type": "twosided", "bsdf": bsdf} if material.two_sided else bsdf)


def make_mesh(shading, albedo, material, points, normals, uv):
    NUMBERED.append((material, shading, albedo))
    props = mi.Properties()
    plain = make_plain_bsdf(material) if shading.takes_plain_bsdfs else None
    props["mesh_bsdf"] = plain or mi.load_dict({"type": "gltf", "number": len(NUMBERED) - 1})
    if max(material.emission) > 0:
        light = {"type": "rgb", "value": material.emission}
        if "emission" in material.textures:
            texels = np.array(material.textures["emission"].map.tensor())[..., :3] * np.array(material.emission, np.float32)
            light = {"type": "bitmap", "bitmap": mi.Bitmap(np.ascontiguousarray(texels, np.float32)), "raw": True}
        props["mesh_emitter"] = mi.load_dict({"type": "area", "radiance": light})
    mesh = mi.Mesh(material.name, len(points), len(points) // 3, has_vertex_normals=True, has_vertex_texcoords=True, props=props)
    values = mi.traverse(mesh)
    values["vertex_positions"], values["vertex_normals"] = points.astype(np.float32).ravel(), normals.astype(np.float32).ravel()
    values["vertex_texcoords"], values["faces"] = uv.astype(np.float32).ravel(), np.arange(len(points), dtype=np.uint32)
    values.update()
    return mesh


def make_scene(parts, environment, shading):
    """Returns a scene of Mitsuba. `environment`: file of an equirectangular picture, +y up, -z in the middle, or None."""
    albedo = make_albedo_table(shading.shadowing)
    scene = {"type": "scene"} | {f"part {i}": make_mesh(shading, albedo, *part) for i, part in enumerate(parts)}
    if environment:
        turn = mi.ScalarTransform4f().rotate([0, 1, 0], 180)
        scene["sky"] = {"type": "envmap", "filename": str(environment), "to_world": turn}
    return mi.load_dict(scene)
