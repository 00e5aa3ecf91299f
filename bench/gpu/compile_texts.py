# SPDX-License-Identifier: MIT
"""Compiles programs by the OpenGL driver that the environment names, and prints the driver's messages: compile_texts.py FILE...

Each file is one of MESA_SHADER_CAPTURE_PATH. A line of JSON per file, after one with the driver. Runs in the root of bench/gpu/compilers; needs PyOpenGL.
"""
import ctypes
import json
import os
import sys
import time
from pathlib import Path

os.environ["PYOPENGL_PLATFORM"] = "egl"

from OpenGL import EGL, GL  # noqa: E402
from shader_texts import sections  # noqa: E402

ATTRIBUTES = (EGL.EGL_CONTEXT_MAJOR_VERSION, 4, EGL.EGL_CONTEXT_MINOR_VERSION, 5, EGL.EGL_CONTEXT_OPENGL_DEBUG, EGL.EGL_TRUE, EGL.EGL_NONE)
KINDS = {"vertex": GL.GL_VERTEX_SHADER, "fragment": GL.GL_FRAGMENT_SHADER, "compute": GL.GL_COMPUTE_SHADER}
MESSAGES = []


@GL.GLDEBUGPROC
def hear(_source, _type, _id, _severity, length, text, _user):
    MESSAGES.append(ctypes.string_at(text, length).decode(errors="replace").strip())


def begin():
    display = EGL.eglGetDisplay(EGL.EGL_DEFAULT_DISPLAY)
    EGL.eglInitialize(display, ctypes.c_long(), ctypes.c_long())
    EGL.eglBindAPI(EGL.EGL_OPENGL_API)
    context = EGL.eglCreateContext(display, EGL.EGLConfig(), EGL.EGL_NO_CONTEXT, (ctypes.c_int * len(ATTRIBUTES))(*ATTRIBUTES))
    EGL.eglMakeCurrent(display, EGL.EGL_NO_SURFACE, EGL.EGL_NO_SURFACE, context)
    GL.glEnable(GL.GL_DEBUG_OUTPUT_SYNCHRONOUS)
    GL.glDebugMessageCallback(hear, None)
    return {"renderer": GL.glGetString(GL.GL_RENDERER).decode(), "version": GL.glGetString(GL.GL_VERSION).decode()}


def compiled(file):
    del MESSAGES[:]
    program, start = GL.glCreateProgram(), time.monotonic()
    for kind, text in sections(file):
        shader = GL.glCreateShader(KINDS[kind])
        GL.glShaderSource(shader, text)
        GL.glCompileShader(shader)
        MESSAGES.append(GL.glGetShaderInfoLog(shader) or "")
        GL.glAttachShader(program, shader)
    GL.glLinkProgram(program)
    right = bool(GL.glGetProgramiv(program, GL.GL_LINK_STATUS))
    return {"file": file.name, "right": right, "seconds": time.monotonic() - start, "messages": [str(m) for m in MESSAGES if m]}


if __name__ == "__main__":
    print(json.dumps(begin()), flush=True)
    for name in sys.argv[1:]:
        print(json.dumps(compiled(Path(name))), flush=True)
