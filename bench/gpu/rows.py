# SPDX-License-Identifier: MIT
"""The measurements of bench/gpu/run: each entry is one call of the program. Seconds are for a GPU, where the whole
takes at most 540."""
from dataclasses import dataclass, field

WHOLE_SECONDS = 540
CORRECTNESS_SECONDS = 150  # limit for all reference pictures together
PICTURE_SECONDS = 30  # limit for one picture
COMPILE_SECONDS = 60  # limit for one program, while others compile

FRAGMENT = ["--dispatch", "fragment"]
COMPUTE = ["--dispatch", "compute", "--schedule", "megakernel"]
LITERALS = ["--traversal", "literals"]
TREE = ["--traversal", "front-to-back"]
WAVEFRONT = ["--schedule", "wavefront"]  # it needs a tree

# The ways to draw reference pictures: the name, the options of `render`, and the only stage that this way draws, or
# None.
ENTRIES = (
    ("fragment entry", FRAGMENT, None),
    ("compute entry", COMPUTE, None),
    ("wavefront", WAVEFRONT, "gi"),
)

HELMET = ["assets/FlightHelmet/FlightHelmet.gltf", "assets/lightroom_14b.hdr"]
SIZE = ["--resolution", "500,500"]
ROUND_TIME = ["--round-time", "0.25"]  # with 0.5 the rows take more than WHOLE_SECONDS
EGL = ["--rendering-backend", "egl"]
BOX_SAMPLES = 128
BOX_AIM = "< 12.5 ms"

# Rows of the report's Table I: part, subject, scene, the method that the options for all draw, these, and other methods by name.
AWAY = "--camera-position 0,900,0 --camera-focal-point 0,1000,0 --camera-view-up 0,0,1"  # sees nothing
STEPS = {"nothing hit": AWAY, "Blinn-Phong": "--stage phong", "shadow rays": "--stage shadows", "reflections": "--stage reflections"}
TRAVERSALS = {"bvh": "--traversal bvh", "iterative": "--traversal iterative"}
REPORT_SCENES = (
    *(("primitives", subject, f"scenes/{scene}.gltf", "flat", ["--stage", "flat"], STEPS)
      for subject, scene in (("1 primitive", "sphere-phong"), ("2 primitives", "sphere-plane"), ("3 primitives", "sphere-plane-mirror"))),
    *(("traversal", subject, f"scenes/{scene}.gltf", "front-to-back", ["--stage", "flat", "--default-light", "white", "--traversal", "front-to-back"], TRAVERSALS)
      for subject, scene in (("15,743 triangles", "mesh-15743"), ("62,975 triangles", "mesh-62975"))),
    ("gi", "Cornell box", "scenes/cornell-box.gltf", f"{BOX_SAMPLES} samples", ["--stage", "gi"], {}),
)
REPORT_SECONDS = 40  # limit for a call
# Milliseconds of the report's GPU by the end of a row's name, from docs/measurements/benchmarks.md; None: the row has
# no figure.
REPORT = {
    "15,743 triangles, iterative": "55", "62,975 triangles, iterative": "226", "15,743 triangles, bvh": "0.66",
    "62,975 triangles, bvh": "0.91", "15,743 triangles, front-to-back": "0.38", "62,975 triangles, front-to-back": "0.43",
    "Cornell box, 128 samples": "125", "nothing hit": None, "flat": "0.29 to 0.30", "Blinn-Phong": "0.29 to 0.30",
    "shadow rays": "0.29 to 0.30", "reflections": "0.29 to 0.30",
}
MESH_AIM = "< 0.1 ms"
REPORT_AIMS = {"62,975 triangles, front-to-back": MESH_AIM, "Cornell box, 128 samples": BOX_AIM}


def report_calls(parts):
    """Yields subject, scene, the method called default, and arguments of each call of `bench frame`. A second one draws a sample at a time, as in a
    viewer, where that is not the same: pictures of many samples have one way, and the iterative traversal's frames are too long."""
    for part, subject, scene, default, shared, methods in REPORT_SCENES:
        for single in (False, True) if part in parts else ():
            if single and part == "gi":
                continue
            own = [word for name, options in methods.items() if not (single and name == "iterative") for word in ("--config", f"{name}={options}")]
            yield subject, scene, default, [*shared, *own, *(("--samples-per-draw", "1") if single else ())]


@dataclass
class Frame:
    """A call of `bench frame`."""
    part: str
    title: str
    scene: str
    options: list
    wants: set  # words of the variant that is to draw
    aim: str = ""
    samples: int = 1  # samples of a picture whose time is reported
    size: str = "500,500"
    seconds: float = 40
    needs: list = field(default_factory=list)  # files that the bundle may lack



def box(part, title, options, wants):
    return Frame(part, title, "scenes/cornell-box.gltf", ["--spp", str(BOX_SAMPLES), *options], wants, BOX_AIM, BOX_SAMPLES)


def mesh(title, options, wants):
    return Frame("mesh", f"62,975 triangles, flat, front to back, {title}", "scenes/mesh-62975.gltf", ["--stage", "flat", "--default-light", "white", *TREE, *options],
                 wants, MESH_AIM)


def ball(title, options, wants):
    return Frame("ball", f"room with the ball, {title}", "scenes/room-ball.gltf", options, wants)


def large(title, options, wants):
    """Sixteen times as many pixels: a lane of the wavefront has 32."""
    return Frame("large", f"room with the ball, 2000 x 2000, {title}", "scenes/room-ball.gltf", options, wants, size="2000,2000")


def medium(scene, title, options, wants):
    return Frame("media", f"{scene}, {title}", f"scenes/{scene}.gltf", options, wants)


def helmet(title, options, wants):
    return Frame("helmet", f"FlightHelmet under lightroom_14b, {title}", HELMET[0], ["--camera-orbit", "0,0", "--hdri-file", HELMET[1], *options], wants, needs=HELMET)


FRAMES = (
    box("box", "fragment, literals", [*FRAGMENT, *LITERALS], {"fragment", "literals"}),
    box("box", "compute, literals", [*COMPUTE, *LITERALS], {"compute", "literals"}),
    box("box", "fragment, tree", [*FRAGMENT, *TREE], {"fragment", "front-to-back"}),
    box("box", "compute, tree", [*COMPUTE, *TREE], {"compute", "front-to-back"}),
    box("box", "wavefront", WAVEFRONT, {"wavefront"}),
    *(box("reads", f"compute, tree, {reads} reads", [*COMPUTE, *TREE, "--buffer-reads", reads], {"compute", f"{reads}-reads"})
      for reads in ("ssbo", "texel")),
    *(box("draws", f"compute, literals, at most {count} samples a draw", [*COMPUTE, *LITERALS, "--samples-per-draw", str(count)],
          {"compute", "literals"}) for count in (1, 8, 32)),
    mesh("fragment", FRAGMENT, {"fragment"}),
    mesh("compute", COMPUTE, {"compute"}),
    ball("fragment", FRAGMENT, {"fragment"}),
    ball("compute", COMPUTE, {"compute"}),
    ball("wavefront", WAVEFRONT, {"wavefront"}),
    ball("compute, all triangles in the tree", [*COMPUTE, *TREE], {"compute", "front-to-back"}),
    ball("compute, not watertight", [*COMPUTE, "--disable", "watertight"], {"compute"}),
    large("compute", COMPUTE, {"compute"}),
    large("wavefront", WAVEFRONT, {"wavefront"}),
    helmet("fragment", FRAGMENT, {"fragment"}),
    helmet("compute", COMPUTE, {"compute"}),
    helmet("wavefront", WAVEFRONT, {"wavefront"}),
    *(medium(scene, title, options, wants) for scene in ("milk", "cloud", "smoke")
      for title, options, wants in (("compute", COMPUTE, {"compute"}), ("wavefront", WAVEFRONT, {"wavefront"}))),
    *(row(f"{entry}, text for software", [*options, "--tune", "software"], wants) for row in (mesh, ball, helmet)
      for entry, options, wants in (("fragment", FRAGMENT, {"fragment"}), ("compute", COMPUTE, {"compute"}))),
)

# Cases that break ray tracers, each seed with others.
STRESS_SEEDS = (0, 1, 2)
STRESS_CALLS = (("rays", []), ("shell", []), ("strips", ["--quick"]), ("boxes", []), ("skins", []), ("leaks", ["--quick"]), ("bad", []), ("glass,contact", []), ("scenes", []),
                ("hits", []), ("tree", []), ("film", ["--quick"]), ("no numbers", []))  # strips: each wedge has a program of its own
STRESS_SECONDS = 500  # limit for all seeds together, so this part needs a call of its own

RAYS = ["scenes/room-ball.gltf", "--plain"]
RAYS_SECONDS = 40
RAY_AIMS = {"diffuse": "2000 Mrays/s"}

# The viewer's pictures while the camera turns: the name, arguments of `bench motion`, and files that the bundle may lack.
MOTION = ["--resolution", "1280,720", "--interval", "16.667", "--pictures", "50", "--compare", "2", "--reference-spp", "128",
          "--modes", "filtered,raw,no-past,spatial"]
MOTIONS = (
    ("Cornell box", ["scenes/cornell-box.gltf"], []),
    ("room with the ball", ["scenes/room-ball.gltf"], []),
    ("FlightHelmet under lightroom_14b", [HELMET[0], "--hdri-file", HELMET[1]], HELMET),
)
MOTION_SECONDS = 60
# The same at the pace of a display.
PACE = ["--resolution", "1280,720", "--interval", "16.667", "--target", "16.667", "--pictures", "300"]
PACE_SECONDS = 20
PACE_AIM = "60 pictures/s, none after more than 50 ms"

# These rows measure from the start of the program to a written picture, with an empty and with a full driver cache.
# Each has a name and arguments of `bench start`.
START = ["--starts", "2", "--spp", "1"]
STARTS = (
    ("room with the ball", ["scenes/room-ball.gltf"], []),
    ("FlightHelmet under lightroom_14b", [HELMET[0], "--hdri-file", HELMET[1]], HELMET),
)
START_SECONDS = 40

# Pictures to look at: each has a file and arguments of `render`.
PICTURES = (
    ("cornell-box.png", ["scenes/cornell-box.gltf", *SIZE, "--spp", "128"], []),
    ("room-ball.png", ["scenes/room-ball.gltf", *SIZE, "--spp", "64"], []),
    ("helmet.png", [HELMET[0], *SIZE, "--spp", "64", "--hdri-file", HELMET[1]], HELMET),
)
PARTS = ("correctness", "report", *dict.fromkeys(frame.part for frame in FRAMES), "rays", "motion", "pace", "start", "pictures")
ASKED_PARTS = ("stress",)  # parts that run only if they are named
