// SPDX-License-Identifier: MIT
// Programs of tests: pure shader files and a main() of their own.
#pragma once

#include <regex>
#include <string>

#include "base/errors.h"
#include "gl/gl.h"
#include "shader/assemble.h"

namespace fragtrace {

inline std::string shaderText(const std::string& name) {
  for (const EmbeddedShader& shader : embeddedShaders()) {
    if (shader.name == name) return std::string(shader.text) + "\n";
  }
  throw RenderError("shader " + name + " does not exist");
}

/// The files without buffers that programs of tests call.
inline std::string probePrelude() {
  std::string text =
      "#version 450 core\nconst bool kAnisotropy = false;\nconst bool kSobol = true;\nconst bool kWatertight "
      "= true;\nconst bool kIterative = "
      "true;\nconst bool kShadowCatcher = false;\nconst bool kTransparentGlass = false;\nconst uint "
      "kPixelOverWhite = 4u;\n";
  for (const char* file : {"mix_bits.glsl", "random.glsl", "sampling.glsl", "luminance.glsl",
                           "intersect.glsl", "perlin.glsl", "fresnel.glsl", "ggx.glsl", "film_pixel.glsl"}) {
    text += shaderText(file);
  }
  // Included files are above.
  return std::regex_replace(text, std::regex("#include [^\n]*\n"), "");
}

inline GlProgram buildComputeProgram(const std::string& text) {
  const char* pointer = text.c_str();
  GlProgram program(glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &pointer));
  GLint ok = 0;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &ok);
  std::string log(4096, '\0');
  glGetProgramInfoLog(program.name(), GLsizei(log.size()), nullptr, log.data());
  if (!ok) throw RenderError("probe does not link:\n" + std::string(log.c_str()));
  return program;
}

}  // namespace fragtrace
