// SPDX-License-Identifier: MIT
// The driver's own offsets, sizes, strides and bindings of what C++ and GLSL share, asked of the tracer's
// program.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "gl/gl.h"
#include "gl/program.h"
#include "gl_probe.h"
#include "shader/assemble.h"
#include "shader/layout.h"

namespace fragtrace {
namespace {

struct Member {
  std::string name;
  size_t offset;
};

#define MEMBER(type, block, member) \
  Member { block "." #member, offsetof(layout::type, member) }
const std::vector<Member> kFrameMembers = {MEMBER(Frame, "frameBlock", cameraPosition),
                                           MEMBER(Frame, "frameBlock", orthographic),
                                           MEMBER(Frame, "frameBlock", cameraRight),
                                           MEMBER(Frame, "frameBlock", firstInMiddle),
                                           MEMBER(Frame, "frameBlock", cameraUp),
                                           MEMBER(Frame, "frameBlock", cameraSolids),
                                           MEMBER(Frame, "frameBlock", cameraForward),
                                           MEMBER(Frame, "frameBlock", metresPerUnit),
                                           MEMBER(Frame, "frameBlock", sceneExtent),
                                           MEMBER(Frame, "frameBlock", treeRounding),
                                           MEMBER(Frame, "frameBlock", background),
                                           MEMBER(Frame, "frameBlock", backgroundShows),
                                           MEMBER(Frame, "frameBlock", environmentSize),
                                           MEMBER(Frame, "frameBlock", environmentRotation),
                                           MEMBER(Frame, "frameBlock", environmentChance),
                                           MEMBER(Frame, "frameBlock", emitterCount),
                                           MEMBER(Frame, "frameBlock", energyRow),
                                           MEMBER(Frame, "frameBlock", punctualCount),
                                           MEMBER(Frame, "frameBlock", pictureSize),
                                           MEMBER(Frame, "frameBlock", samplesWanted),
                                           MEMBER(Frame, "frameBlock", seed),
                                           MEMBER(Frame, "frameBlock", tile),
                                           MEMBER(Frame, "frameBlock", maxBounces),
                                           MEMBER(Frame, "frameBlock", rouletteDepth),
                                           MEMBER(Frame, "frameBlock", stepBudget),
                                           MEMBER(Frame, "frameBlock", leafCount),
                                           MEMBER(Frame, "frameBlock", firstSample),
                                           MEMBER(Frame, "frameBlock", clampBits),
                                           MEMBER(Frame, "frameBlock", tileGoesOn),
                                           MEMBER(Frame, "frameBlock", objectRow),
                                           MEMBER(Frame, "frameBlock", filmOffset),
                                           MEMBER(Frame, "frameBlock", backdropSize),
                                           MEMBER(Frame, "frameBlock", worldOrigin),
                                           MEMBER(Frame, "frameBlock", catcherHeight),
                                           MEMBER(Frame, "frameBlock", catcherIrradiance),
                                           MEMBER(Frame, "frameBlock", lensShift),
                                           MEMBER(Frame, "frameBlock", shadowFade),
                                           MEMBER(Frame, "frameBlock", segments),
                                           MEMBER(Frame, "frameBlock", environmentScale),
                                           MEMBER(Frame, "frameBlock", lens)};
const std::vector<Member> kProgressMembers = {
    MEMBER(Progress, "progress", unfinished), MEMBER(Progress, "progress", stuck),
    MEMBER(Progress, "progress", cutLow), MEMBER(Progress, "progress", cutHigh)};
#undef MEMBER

/// One property of one named resource, -1 where the program has no such resource.
GLint askProgram(const GlProgram& program, GLenum interface, const std::string& name, GLenum property) {
  const GLuint index = glGetProgramResourceIndex(program.name(), interface, name.c_str());
  if (index == GL_INVALID_INDEX) return -1;
  GLint value = -1;
  glGetProgramResourceiv(program.name(), interface, index, 1, &property, 1, nullptr, &value);
  return value;
}

class Layout : public GlProbe {
 protected:
  void SetUp() override {
    GlProbe::SetUp();
    if (IsSkipped()) return;
    // Everything on, so that every buffer is read.
    ShaderVariant variant;
    variant.stages = stagesUpTo(Stage::Gi);
    variant.traits.set();
    variant.reads = BufferReads::Ssbo;
    variant.resumable = true;
    const ShaderSource source = shaderSource({});
    program_ = buildProgram(assembleShader(source, "entry/fullscreen.vert", variant),
                            assembleShader(source, "entry/trace.frag", variant));
  }

  void expectMembers(GLenum interface, const std::vector<Member>& members) {
    for (const Member& m : members)
      EXPECT_EQ(askProgram(program_, interface, m.name, GL_OFFSET), GLint(m.offset)) << m.name;
  }

  GlProgram program_;
};

TEST_P(Layout, FrameLiesWhereTheDriverLooksForIt) {
  expectMembers(GL_UNIFORM, kFrameMembers);
  EXPECT_EQ(askProgram(program_, GL_UNIFORM_BLOCK, "FrameBlock", GL_NUM_ACTIVE_VARIABLES),
            GLint(kFrameMembers.size()));
  EXPECT_EQ(askProgram(program_, GL_UNIFORM_BLOCK, "FrameBlock", GL_BUFFER_DATA_SIZE),
            GLint(sizeof(layout::Frame)));
  EXPECT_EQ(askProgram(program_, GL_UNIFORM_BLOCK, "FrameBlock", GL_BUFFER_BINDING),
            GLint(layout::kFrameBinding));
}

TEST_P(Layout, ProgressLiesWhereTheDriverWritesIt) {
  expectMembers(GL_BUFFER_VARIABLE, kProgressMembers);
  EXPECT_EQ(askProgram(program_, GL_SHADER_STORAGE_BLOCK, "ProgressBlock", GL_NUM_ACTIVE_VARIABLES),
            GLint(kProgressMembers.size()));
  EXPECT_EQ(askProgram(program_, GL_SHADER_STORAGE_BLOCK, "ProgressBlock", GL_BUFFER_DATA_SIZE),
            GLint(sizeof(layout::Progress)));
  EXPECT_EQ(askProgram(program_, GL_SHADER_STORAGE_BLOCK, "ProgressBlock", GL_BUFFER_BINDING),
            GLint(layout::kProgressBinding));
}

TEST_P(Layout, SceneBuffersHaveTheirBindingsAndRows) {
  struct Row {
    std::string block;
    std::string array;
    uint32_t binding;
    GLint bytes;
  };
  const std::vector<Row> rows = {
      {"NodesBlock", "nodesBuffer", layout::kNodesBinding, 16},
      {"LeavesBlock", "leavesBuffer", layout::kLeavesBinding, 16},
      {"FacesBlock", "facesBuffer", layout::kFacesBinding, 16},
      {"NormalsBlock", "normalsBuffer", layout::kNormalsBinding, 16},
      {"TexcoordsBlock", "texcoordsBuffer", layout::kTexcoordsBinding, 16},
      {"TangentsBlock", "tangentsBuffer", layout::kTangentsBinding, 16},
      {"ColorsBlock", "colorsBuffer", layout::kColorsBinding, 16},
      {"MaterialsBlock", "materialsBuffer", layout::kMaterialsBinding, 16},
      {"BricksBlock", "bricksBuffer", layout::kBricksBinding, 8},
      {"EmittersBlock", "emittersBuffer", layout::kEmittersBinding, 16},
      {"LightsBlock", "lightsBuffer", layout::kLightsBinding, 16},
      {"EnvironmentBlock", "environmentBuffer", layout::kEnvironmentBinding, 16},
      {"EnvironmentInversionBlock", "environmentInversionBuffer", layout::kEnvironmentInversionBinding, 16}};
  ASSERT_EQ(rows.size(), layout::kSceneBufferCount);
  for (const Row& row : rows) {
    EXPECT_EQ(askProgram(program_, GL_SHADER_STORAGE_BLOCK, row.block, GL_BUFFER_BINDING), GLint(row.binding))
        << row.block;
    EXPECT_EQ(askProgram(program_, GL_BUFFER_VARIABLE, row.array + "[0]", GL_ARRAY_STRIDE), row.bytes)
        << row.array;
  }
  // A suspended path is rows of the same kind.
  EXPECT_EQ(askProgram(program_, GL_SHADER_STORAGE_BLOCK, "PathStatesBlock", GL_BUFFER_BINDING),
            GLint(layout::kPathStatesBinding));
  EXPECT_EQ(askProgram(program_, GL_BUFFER_VARIABLE, "pathStates[0]", GL_ARRAY_STRIDE), 16);
}

INSTANTIATE_TEST_SUITE_P(Driver, Layout, bothBackends(), backendName);

}  // namespace
}  // namespace fragtrace
