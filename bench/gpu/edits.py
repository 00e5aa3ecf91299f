# SPDX-License-Identifier: MIT
"""Folders of shaders for rows of the bundle: the changes of `--tune gpu`, taken back one at a time, and work groups of other sizes. A
change that no longer finds its text ends with an error, so that a row cannot measure nothing."""
import shutil

LANES = "const int kGroupLanes = 64;"
LOCAL = "layout(local_size_x = 8, local_size_y = 8) in;"
WHICH_GROUP = "ivec2 laneOfTile(ivec2 lanes) {\n"


def lanes(groups):
    """A work group does what so many of 64 lanes do; those beyond the last have nothing to do."""
    return {
        "entry/trace.comp": [(LOCAL, f"layout(local_size_x = 8, local_size_y = {8 * groups}) in;")],
        "tune/stack_shared.glsl": [(LANES, f"const int kGroupLanes = {64 * groups};")],
        "work_group.glsl": [
            ("gl_WorkGroupID.x", "groupOfLane()"),
            ("gl_LocalInvocationID.xy", "gl_LocalInvocationID.xy & 7u"),
            (WHICH_GROUP, f"uint groupOfLane() {{ return gl_WorkGroupID.x * {groups}u + gl_LocalInvocationID.y / 8u; }}\n\n" + WHICH_GROUP +
             "  if (groupOfLane() >= gl_NumWorkGroups.x) return lanes;\n"),
        ],
    }


KEPT_FILM = {"trace.glsl": [("if (kGpu) film = loadFilm(pixel);", ""), ("if (kGpu) storeFilm(pixel, film);", "")]}

# The edits of each file, by name: the file that replaces it, or texts and their replacements, everywhere.
EDITS = {
    "copied-frame": {"tune/frame_uniform.glsl": "tune/frame_variable.glsl"},
    "kept-film": KEPT_FILM,
    "two-traversals": {"trace.glsl": [("!kGpu && kShadows", "kShadows"), ("kGpu && kShadows &&", "false &&"), ("kGpu && kWholeRays && isShadow", "false"),
                                      ("kGpu && isShadow", "false")]},
    "array-stack": {"tune/stack_shared.glsl": [("shared int stackEntries[kStackSize * kGroupLanes];", "int stackEntries[kStackSize];"),
                                               ("return entry * kGroupLanes + int(gl_LocalInvocationIndex);", "return entry;")]},
    "128-lanes": lanes(2),
    "256-lanes": lanes(4),
    "film-and-128-lanes": KEPT_FILM | lanes(2),
}


def write_edited(shaders, folder):
    """Writes a folder of shaders for each edit, named after it, into `folder`."""
    folder.mkdir()
    for name, edits in EDITS.items():
        target = folder / name
        shutil.copytree(shaders, target)
        for file, changes in edits.items():
            path = target / file
            if isinstance(changes, str):
                path.write_text((target / changes).read_text())
                continue
            text = path.read_text()
            for old, new in changes:
                if old not in text:
                    raise SystemExit(f"{name}: {file} no longer has the text {old!r}")
                text = text.replace(old, new)
            path.write_text(text)
