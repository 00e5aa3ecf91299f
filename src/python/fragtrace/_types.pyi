# SPDX-License-Identifier: MIT
"""The keywords of fragtrace.render() and sequence(). scripts/option_reference writes them."""
from collections.abc import Sequence
from os import PathLike
from typing import Any, Literal, TypedDict

class Keywords(TypedDict, total=False):
    resolution: str | Sequence[int] | None
    camera_index: int | None
    camera: dict[str, Any] | str | float | None
    camera_position: str | Sequence[float] | None
    camera_orbit: str | Sequence[float] | None
    fit: dict[str, Any] | bool | None
    fit_shadow: bool | None
    fit_to: str | float | None
    fill: float | None
    camera_focal_point: str | Sequence[float] | None
    camera_view_up: str | Sequence[float] | None
    camera_type: Literal["perspective", "orthographic", "panorama", "fisheye"] | None
    camera_view_angle: float | None
    focal_length: str | Sequence[float] | None
    camera_parallel_scale: float | None
    lens_shift: str | Sequence[float] | None
    f_stop: float | None
    focus_distance: float | None
    aperture_blades: int | None
    scene_origin: str | Sequence[float] | None
    pixel_filter: Literal["box", "gaussian", "blackman-harris"] | None
    line_width: float | None
    stage: Literal["flat", "phong", "shadows", "reflections", "refraction", "normal-maps", "gi"] | None
    enable: Literal["flat", "phong", "shadows", "reflections", "refraction", "normal-maps", "gi", "schlick", "energy-compensation", "sobol", "light-sampling", "watertight"] | str | Sequence[str] | None
    disable: Literal["flat", "phong", "shadows", "reflections", "refraction", "normal-maps", "gi", "schlick", "energy-compensation", "sobol", "light-sampling", "watertight"] | str | Sequence[str] | None
    spp: int | None
    noise: float | None
    quality: Literal["none", "draft", "good", "best"] | None
    time: float | None
    sample_offset: int | None
    seed: int | None
    bounces: str | float | None
    camera_rays: int | None
    rr_depth: int | None
    clamp_indirect: float | None
    texture_filter: Literal["exact", "cones"] | None
    light_selection: Literal["auto", "tree", "power", "uniform"] | None
    light_reuse: Literal["none", "candidates", "spatial"] | None
    caustics: Literal["auto", "on", "off"] | None
    hdri_file: str | PathLike[str] | None
    hdri_rotation: float | None
    hdri_intensity: float | None
    background_blur: float | None
    studio: dict[str, Any] | bool | None
    studio_look: Literal["soft", "white", "dark"] | None
    shop: bool | None
    shadow_catcher: str | float | None
    ground: dict[str, Any] | str | float | Sequence[float] | None
    shadow_fade: str | Sequence[float] | None
    no_background: bool | None
    transparent_glass: bool | None
    background_color: str | float | Sequence[float] | None
    default_light: Literal["white", "studio", "none"] | None
    no_default_light: bool | None
    lamp_units: Literal["auto", "photometric", "radiometric"] | None
    sky: dict[str, Any] | bool | None
    sun_elevation: float | None
    sun_azimuth: float | None
    sun_time: str | float | None
    sun_place: str | Sequence[float] | None
    sky_turbidity: float | None
    ground_albedo: float | None
    fog_density: float | None
    fog_color: str | float | Sequence[float] | None
    fog_anisotropy: float | None
    fog_height: str | float | Sequence[float] | None
    fog_distance: float | None
    volume: dict[str, Any] | str | PathLike[str] | None
    volume_position: str | Sequence[float] | None
    volume_scale: float | None
    volume_density: float | None
    volume_color: str | float | Sequence[float] | None
    volume_anisotropy: float | None
    volume_emission: float | None
    traversal: Literal["auto", "iterative", "bvh", "front-to-back", "literals"] | None
    instancing: Literal["auto", "flatten", "share"] | None
    rendering_backend: Literal["auto", "egl", "osmesa"] | None
    device: str | float | None
    buffer_reads: Literal["auto", "ssbo", "image", "texel"] | None
    texture_reads: Literal["auto", "words", "arrays"] | None
    dispatch: Literal["auto", "fragment", "compute"] | None
    tune: Literal["auto", "software", "gpu"] | None
    vector_width: Literal["auto", "256", "512"] | None
    schedule: Literal["auto", "megakernel", "wavefront"] | None
    shader_folder: str | PathLike[str] | None
    scene: dict[str, Any] | str | float | None
    animation_time: float | None
    animation: dict[str, Any] | str | float | None
    material_variant: str | float | None
    hide: str | float | Sequence[str] | None
    double_sided: str | float | Sequence[str] | None
    set: str | float | Sequence[str] | None
    add_light: str | float | Sequence[str] | None
    up: str | float | Sequence[float] | None
    memory_limit: str | float | None
    texture_limit: int | None
    missing_textures: Literal["refuse", "magenta"] | None
    strict: bool | None
    allow_external_files: bool | None
    ignore_required: str | float | Sequence[str] | None
    aov: str | float | str | Sequence[str] | None
    debug_view: Literal["none", "geometric-normal", "normal", "albedo", "roughness", "texcoords", "depth", "visits", "samples", "variance"] | None
    tree_level: int | None
    ocio_view: str | float | None
    ocio_config: str | PathLike[str] | None
    ocio_display: str | float | None
    ocio_look: str | float | None
    ocio_input: str | float | None
    region: str | Sequence[int] | None
    shader_text: str | PathLike[str] | None
    trace_file: str | PathLike[str] | None
    count_work: bool | None
    fps: float | None
    shutter: float | None
    denoise: Literal["none", "variance", "oidn", "auto"] | None
    oidn_library: str | PathLike[str] | None
    config: str | PathLike[str] | None
    hdri: dict[str, Any] | str | PathLike[str] | None

class SequenceKeywords(Keywords, total=False):
    frames: range | str | float | None
    turntable: int | None
    turn: Literal["camera", "object"] | None
