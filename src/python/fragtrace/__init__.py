# SPDX-License-Identifier: MIT
"""Path tracing of glTF scenes in an OpenGL shader.

    import fragtrace
    picture = fragtrace.render("helmet.glb", spp=64, resolution=(640, 360))   # a NumPy array (height, width, 4)
    picture.save("helmet.png")

Most options of the command `fragtrace render` are keywords: --sample-offset is sample_offset=. Colours are linear, Rec. 709 primaries,
float32; the first row is the top."""
from fragtrace._core import ContextError, InputError, RenderError, UsageError, __version__
from fragtrace._files import diff, info, merge, read
from fragtrace._picture import Layers, Picture, tonemap
from fragtrace._scene import Scene, render, sequence

__all__ = ["ContextError", "InputError", "Layers", "Picture", "RenderError", "Scene", "UsageError", "__version__", "diff", "info", "merge", "read",
           "render", "sequence", "tonemap"]
