// SPDX-License-Identifier: MIT
#include "view/files.h"

#include <gtest/gtest.h>

namespace fragtrace {
namespace {

constexpr glm::dvec3 kUp(0, 0, 1);

TEST(DroppedFile, IsToldByItsExtension) {
  for (const char* name : {"a.gltf", "b.GLB", "dir.hdr/c.Gltf"})
    EXPECT_EQ(kindOfDropped(name), DroppedFile::Scene) << name;
  for (const char* name : {"a.hdr", "b.EXR", "c.pfm"})
    EXPECT_EQ(kindOfDropped(name), DroppedFile::Environment) << name;
  for (const char* name : {"a.png", "gltf", "", "folder", "x.gltf.bak"})
    EXPECT_EQ(kindOfDropped(name), DroppedFile::Unknown) << name;
}

TEST(Drop, ASceneAndAnEnvironmentAreBothTaken) {
  RenderOptions shown;
  shown.scene = "old.gltf";
  shown.camera.index = 3;
  shown.output.exposure = 1.0;
  for (const std::vector<std::filesystem::path>& files :
       {std::vector<std::filesystem::path>{"a.glb", "b.hdr"}, {"b.hdr", "a.glb"}}) {
    const Drop drop = takeDrop(shown, files, kUp);
    ASSERT_TRUE(drop.load);
    EXPECT_EQ(drop.load->scene, "a.glb");
    EXPECT_EQ(drop.load->light.hdriFile, "b.hdr");
    EXPECT_FALSE(drop.load->camera.index);
    EXPECT_EQ(drop.load->output.exposure, 1.0);
    EXPECT_TRUE(drop.refused.empty());
  }
}

/// The axis of --up is of all files of that program; one by which a file was levelled is of that file.
TEST(Drop, OfTheSelectionTheUpAxisOfTheStartStays) {
  const std::vector<std::filesystem::path> files{"a.glb"};
  RenderOptions shown;
  shown.selection.up = {0.1, 0.9, 0};
  shown.selection.scene = "second";
  const SceneSelection kept{.up = kUp};
  EXPECT_EQ(takeDrop(shown, files, kUp).load->selection, kept);
}

TEST(Drop, APictureOfLinearRadianceMayBeAReference) {
  for (const char* name : {"a.exr", "b.PFM", "c.png", "d.jpg"}) EXPECT_TRUE(mayBeReference(name)) << name;
  for (const char* name : {"a.hdr", "c.glb", "exr"}) EXPECT_FALSE(mayBeReference(name)) << name;
}

TEST(Drop, WhatIsNotTakenIsSaid) {
  const std::vector<std::filesystem::path> files{"a.glb", "x.png", "b.glb"};
  const Drop drop = takeDrop({}, files, kUp);
  EXPECT_EQ(drop.load->scene, "b.glb");
  ASSERT_EQ(drop.refused.size(), 2u);
  EXPECT_TRUE(drop.refused[0].starts_with("x.png is neither")) << drop.refused[0];
  EXPECT_TRUE(drop.refused[1].starts_with("a.glb: only the last")) << drop.refused[1];
  EXPECT_FALSE(takeDrop({}, std::span(files).subspan(1, 1), kUp).load);
}

}  // namespace
}  // namespace fragtrace
