// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gl/gl.h"
#include "shader/assemble.h"

namespace fragtrace {

/// A program that the driver compiles, perhaps in threads of its own: nothing is asked of it yet.
struct StartedProgram {
  std::vector<GlShader> shaders;
  GlProgram program;
};
StartedProgram startProgram(const std::string& vertexText, const std::string& fragmentText);
/// Waits for the program. Throws RenderError with the driver's log, which names shader file and line.
GlProgram finished(StartedProgram started);

/// Starts and finishes one program. Throws as finished() does.
GlProgram buildProgram(const std::string& vertexText, const std::string& fragmentText);
GlProgram buildComputeProgram(const std::string& text);

/// The file of shaders/entry that a variant's tracer begins with.
const char* tracerEntry(const ShaderVariant& variant);

/// Programs by variant, built on first use and kept.
class ProgramCache {
 public:
  explicit ProgramCache(ShaderSource source) : source_(std::move(source)) {}
  const GlProgram& tracerProgram(const ShaderVariant& variant);
  /// Adds light paths to a film through the pixel filter of the variant.
  const GlProgram& splatter(const ShaderVariant& variant);
  void clear();
  size_t count() const { return tracers_.size() + splatters_.size(); }
  size_t characters() const { return characters_; }  ///< of their texts

 private:
  std::string textOf(const std::string& entry, const ShaderVariant& variant);

  ShaderSource source_;
  std::map<ShaderVariant, GlProgram> tracers_;
  std::map<PixelFilter, GlProgram> splatters_;
  size_t characters_ = 0;
};

/// The source for this driver's compiler; needs a current context.
ShaderSource shaderSource(const std::filesystem::path& folder);

}  // namespace fragtrace
