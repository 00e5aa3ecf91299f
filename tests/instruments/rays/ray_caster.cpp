// SPDX-License-Identifier: MIT
#include "tests/instruments/rays/ray_caster.h"

#include <chrono>
#include <utility>

#include "base/errors.h"
#include "pack/pack_tree.h"

namespace fragtrace {

namespace {

constexpr int32_t kUnfinished = -2;  // as traceRay() of shaders/rays.glsl writes it
/// llvmpipe ends all loops of an invocation after 65,535 iterations in total, and a step may take three of
/// them.
constexpr int kStepLimit = 20000;

GLuint makeFramebuffer(glm::ivec2 size) {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  glNamedFramebufferParameteri(name, GL_FRAMEBUFFER_DEFAULT_WIDTH, size.x);
  glNamedFramebufferParameteri(name, GL_FRAMEBUFFER_DEFAULT_HEIGHT, size.y);
  return name;
}

layout::Frame frameOf(const GpuScene& scene, glm::ivec2 size) {
  layout::Frame frame{};
  frame.sceneExtent = scene.extent;
  frame.treeRounding = treeRounding(scene.extent);
  frame.pictureSize = size;
  frame.samplesWanted = 1;
  frame.stepBudget = kStepLimit;
  frame.leafCount = int(scene.leafCount);
  return frame;
}

GlBuffer makeFrameBuffer(const layout::Frame& frame) {
  GlBuffer buffer = makeBuffer();
  glNamedBufferStorage(buffer.name(), sizeof frame, &frame, 0);
  return buffer;
}

/// The program that finds the nearest hits, or any.
GlProgram buildEntry(const std::filesystem::path& folder, const std::string& name, bool anyHit,
                     const ShaderVariant& variant) {
  const ShaderSource source = shaderSource(folder);
  const std::string entry = "entry/" + name + (anyHit ? "_any" : "_nearest");
  if (variant.dispatch == Dispatch::Compute)
    return buildComputeProgram(assembleShader(source, entry + ".comp", variant));
  return buildProgram(assembleShader(source, "entry/fullscreen.vert", variant),
                      assembleShader(source, entry + ".frag", variant));
}

}  // namespace

RayCaster::RaySet::RaySet(std::span<const Ray> rays) : buffer_(makeBuffer()) {
  std::vector<glm::vec4> rows;
  rows.reserve(rays.size() * 2);
  for (const Ray& ray : rays) {
    rows.emplace_back(ray.origin, ray.limit);
    rows.emplace_back(ray.direction, 0.0f);
  }
  glNamedBufferStorage(buffer_.name(), GLsizeiptr(rows.size() * sizeof(glm::vec4)), rows.data(), 0);
  checkGl("uploading rays");
}

RayCaster::RayCaster(const Context& context, GpuScene scene, const ShaderVariant& variant, glm::ivec2 size,
                     const std::filesystem::path& shaderFolder, std::string entry)
    : buffers_(scene, variant.reads),
      variant_(variant),
      shaderFolder_(shaderFolder),
      entry_(std::move(entry)),
      frameBuffer_(makeFrameBuffer(frameOf(scene, size))),
      hitBuffer_(makeBuffer()),
      vertexArray_(makeVertexArray()),
      framebuffer_(makeFramebuffer(size)),
      timer_(makeQuery(GL_TIME_ELAPSED)),
      size_(size),
      software_(context.software) {
  glNamedBufferStorage(hitBuffer_.name(), GLsizeiptr(size.x) * size.y * GLsizeiptr(sizeof(TracedRay)),
                       nullptr, 0);
  checkGl("making room for hits");
}

const GlProgram& RayCaster::program(bool anyHit) {
  std::optional<GlProgram>& program = programs_[anyHit ? 1 : 0];
  if (!program) program = buildEntry(shaderFolder_, entry_, anyHit, variant_);
  return *program;
}

double RayCaster::trace(const RaySet& rays, bool anyHit) {
  buffers_.bind();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glBindVertexArray(vertexArray_.name());
  glViewport(0, 0, size_.x, size_.y);
  glUseProgram(program(anyHit).name());
  glBindBufferBase(GL_UNIFORM_BUFFER, layout::kFrameBinding, frameBuffer_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kPathStatesBinding, rays.buffer_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kProgressBinding, hitBuffer_.name());
  glFinish();

  const auto start = std::chrono::steady_clock::now();
  if (!software_) glBeginQuery(GL_TIME_ELAPSED, timer_.name());
  if (variant_.dispatch == Dispatch::Compute)
    glDispatchCompute(GLuint(size_.x + 7) / 8u, GLuint(size_.y + 7) / 8u, 1);
  else
    glDrawArrays(GL_TRIANGLES, 0, 3);
  if (!software_) glEndQuery(GL_TIME_ELAPSED);
  glFinish();
  const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
  GLuint64 nanoseconds = 0;
  if (!software_) glGetQueryObjectui64v(timer_.name(), GL_QUERY_RESULT, &nanoseconds);
  checkGl("tracing rays");
  return software_ ? wall.count() : double(nanoseconds) / 1e6;
}

std::vector<TracedRay> RayCaster::hits() const {
  std::vector<TracedRay> hits(size_t(size_.x) * size_t(size_.y));
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(hitBuffer_.name(), 0, GLsizeiptr(hits.size() * sizeof(TracedRay)), hits.data());
  checkGl("reading hits");
  for (const TracedRay& hit : hits) {
    if (hit.slot == kUnfinished) {
      throw RenderError("a ray took more than " + std::to_string(kStepLimit) +
                        " steps, which is more than one draw allows");
    }
  }
  return hits;
}

}  // namespace fragtrace
