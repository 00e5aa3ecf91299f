// SPDX-License-Identifier: MIT
// Every switch of the shader is right GLSL, on its own and left out of the full shader, by another compiler
// than the driver's: one run of glslangValidator. tests/probe/variants_test.cpp links three on the driver.
#include <gtest/gtest.h>

#include <sys/wait.h>

#include <array>
#include <cstdlib>
#include <fstream>

#include "image_test_folder.h"
#include "shader/assemble.h"

namespace fragtrace {
namespace {

ShaderVariant full(BufferReads reads) {
  ShaderVariant v;
  v.stages.set();
  v.traits.set();
  v.reads = reads;
  return v;
}

/// The full shader without each stage and trait, and each alone.
void addSwitches(BufferReads reads, std::vector<ShaderVariant>& variants) {
  for (const StageRow& row : stageRows()) {
    variants.push_back(full(reads));
    variants.back().stages.flip(size_t(row.stage));
    variants.push_back(full(reads));
    variants.back().stages.reset().set(size_t(row.stage));
  }
  for (const TraitRow& row : traitRows()) {
    variants.push_back(full(reads));
    variants.back().traits.reset(size_t(row.trait));
    variants.push_back(full(reads));
    variants.back().traits.reset().set(size_t(row.trait));
  }
}

/// Each entry, full and empty, and each size of the stack, by one kind of reads.
void addEntries(BufferReads reads, std::vector<ShaderVariant>& variants) {
  ShaderVariant empty;
  empty.reads = reads;
  ShaderVariant compute = full(reads);
  compute.dispatch = Dispatch::Compute;
  ShaderVariant wavefront = compute;
  wavefront.wavefront = true;
  ShaderVariant resumable = full(reads);
  resumable.resumable = true;
  ShaderVariant cones = wavefront;
  cones.rayCones = true;
  ShaderVariant conesInArrays = full(reads);
  conesInArrays.rayCones = conesInArrays.textureArrays = true;
  for (ShaderVariant& v :
       std::array{full(reads), empty, compute, wavefront, resumable, cones, conesInArrays}) {
    variants.push_back(v);
    v.gpu = true;
    variants.push_back(v);
  }
  // Each integrator.
  for (size_t aov = 0; aov < kAovRows.size(); ++aov) {
    variants.push_back(full(reads));
    variants.back().aov = Aov(aov);
    variants.back().resumable = true;
  }
  for (bool ShaderVariant::*own :
       {&ShaderVariant::lightPaths, &ShaderVariant::storesReservoirs, &ShaderVariant::neighbours,
        &ShaderVariant::countsVisits, &ShaderVariant::shadowCatcher, &ShaderVariant::transparentGlass,
        &ShaderVariant::lightCandidates, &ShaderVariant::countsWork}) {
    ShaderVariant v = full(reads);
    v.*own = v.resumable = true;
    variants.push_back(v);
    v.aov = Aov::Guides;
    variants.push_back(v);
  }
  for (const TraversalMethod method :
       {TraversalMethod::Iterative, TraversalMethod::Bvh, TraversalMethod::FrontToBack}) {
    for (const int size : {8, 12, 16, 20, 24, 32, 48}) {
      ShaderVariant v = full(reads);
      v.traversal = method;
      v.stackSize = size;
      v.stages.reset().set(size_t(Stage::Flat));
      variants.push_back(v);
    }
  }
}

using VariantTexts = ImageTestFolder;

TEST_F(VariantTexts, EverySwitchLeftOutOrAloneIsRight) {
  std::vector<ShaderVariant> variants;
  for (const BufferReads reads : {BufferReads::Image, BufferReads::Ssbo, BufferReads::Texel})
    addEntries(reads, variants);
  for (const BufferReads reads : {BufferReads::Image, BufferReads::Ssbo}) addSwitches(reads, variants);
  std::string command = "glslangValidator -t";
  for (size_t i = 0; i < variants.size(); ++i) {
    const ShaderVariant& v = variants[i];
    const bool compute = v.dispatch == Dispatch::Compute;
    const char* entry = v.wavefront ? "entry/wavefront.comp"
                        : compute   ? "entry/trace.comp"
                                    : "entry/trace.frag";
    const std::filesystem::path file = folder / (std::to_string(i) + (compute ? ".comp" : ".frag"));
    std::ofstream(file) << assembleShader({}, entry, v);
    command += " " + file.string();
  }
  const std::filesystem::path told = folder / "told.txt";
  const int status = std::system((command + " > " + told.string()).c_str());
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127) GTEST_SKIP() << "glslangValidator is not installed";
  EXPECT_EQ(status, 0);
  // It prints the name of each file, and below it what is wrong with it.
  std::ifstream said(told);
  std::string name;
  for (std::string line; std::getline(said, line);) {
    if (line.starts_with(folder.string())) name = std::filesystem::path(line).stem().string();
    if (line.starts_with("ERROR:")) ADD_FAILURE() << line << "\n" << variantName(variants[std::stoul(name)]);
  }
}

}  // namespace
}  // namespace fragtrace
