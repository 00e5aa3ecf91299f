// SPDX-License-Identifier: MIT
#include "gl/program.h"

#include "base/errors.h"
#include "base/timeline.h"

namespace fragtrace {

namespace {

/// The result is read only if a program does not link: drivers that compile in threads of their own would
/// have to wait for it.
GlShader compileShader(GLenum kind, const std::string& text) {
  GlShader shader(glCreateShader(kind));
  const char* pointer = text.c_str();
  glShaderSource(shader.name(), 1, &pointer, nullptr);
  glCompileShader(shader.name());
  return shader;
}

void checkCompiled(const GlShader& shader) {
  GLint ok = 0;
  glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &ok);
  if (ok) return;
  checkGl("compiling a shader");
  GLint length = 0;
  glGetShaderiv(shader.name(), GL_INFO_LOG_LENGTH, &length);
  std::string log(size_t(length) + 1, '\0');
  glGetShaderInfoLog(shader.name(), length, nullptr, log.data());
  throw RenderError("shader does not compile:\n" + std::string(log.c_str()));
}

StartedProgram link(std::vector<GlShader> shaders) {
  GlProgram program(glCreateProgram());
  for (const GlShader& shader : shaders) glAttachShader(program.name(), shader.name());
  glLinkProgram(program.name());
  return {std::move(shaders), std::move(program)};
}

}  // namespace

StartedProgram startProgram(const std::string& vertexText, const std::string& fragmentText) {
  std::vector<GlShader> shaders;
  shaders.push_back(compileShader(GL_VERTEX_SHADER, vertexText));
  shaders.push_back(compileShader(GL_FRAGMENT_SHADER, fragmentText));
  return link(std::move(shaders));
}

GlProgram finished(StartedProgram started) {
  const GLuint program = started.program.name();
  GLint ok = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &ok);
  if (!ok) {
    for (const GlShader& shader : started.shaders) checkCompiled(shader);
    checkGl("linking a shader program");
    GLint length = 0;
    glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
    std::string log(size_t(length) + 1, '\0');
    glGetProgramInfoLog(program, length, nullptr, log.data());
    throw RenderError("shader program does not link:\n" + std::string(log.c_str()));
  }
  return std::move(started.program);
}

GlProgram buildProgram(const std::string& vertexText, const std::string& fragmentText) {
  return finished(startProgram(vertexText, fragmentText));
}

GlProgram buildComputeProgram(const std::string& text) {
  std::vector<GlShader> shaders;
  shaders.push_back(compileShader(GL_COMPUTE_SHADER, text));
  return finished(link(std::move(shaders)));
}

const char* tracerEntry(const ShaderVariant& variant) {
  if (variant.dispatch != Dispatch::Compute) return "entry/trace.frag";
  return variant.wavefront ? "entry/wavefront.comp" : "entry/trace.comp";
}

std::string ProgramCache::textOf(const std::string& entry, const ShaderVariant& variant) {
  std::string text = assembleShader(source_, entry, variant);
  characters_ += text.size();
  return text;
}

const GlProgram& ProgramCache::tracerProgram(const ShaderVariant& variant) {
  const auto found = tracers_.find(variant);
  if (found != tracers_.end()) return found->second;
  const TimelineSpan span(variant.lightPaths ? "compile light paths" : "compile " + variantName(variant));
  const std::string text = textOf(tracerEntry(variant), variant);
  GlProgram program = variant.dispatch == Dispatch::Compute
                          ? buildComputeProgram(text)
                          : buildProgram(textOf("entry/fullscreen.vert", variant), text);
  checkGl("building a shader program");
  return tracers_.emplace(variant, std::move(program)).first->second;
}

const GlProgram& ProgramCache::splatter(const ShaderVariant& variant) {
  const auto found = splatters_.find(variant.pixelFilter);
  if (found != splatters_.end()) return found->second;
  GlProgram program = buildProgram(textOf("entry/splat.vert", variant), textOf("entry/splat.frag", variant));
  checkGl("building the program of splats");
  return splatters_.emplace(variant.pixelFilter, std::move(program)).first->second;
}

void ProgramCache::clear() {
  tracers_.clear();
  splatters_.clear();
  characters_ = 0;
}

ShaderSource shaderSource(const std::filesystem::path& folder) {
  return {folder, GLAD_GL_ARB_shading_language_include != 0};
}

}  // namespace fragtrace
