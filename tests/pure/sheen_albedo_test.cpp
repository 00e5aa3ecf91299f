// SPDX-License-Identifier: MIT
#include "pack/energy_tables.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "shader_bsdf_cases.h"

namespace fragtrace {
namespace {

TEST(SheenAlbedo, IsTheIntegralOfTheLobe) {
  for (double roughness : {0.25, 0.4, 0.7, 1.0}) {
    const double alpha = roughness * roughness;
    for (double z : {0.9, 0.5, 0.2}) {
      const dvec3 o = atElevation(z);
      // The shader's lobe is undivided here: no direction gives out more than it gets.
      const With sheen(glsl_variant::kSheen, true);
      const double integral = total(integrateBins([&](const dvec3& i) {
        return i.z > 0.0 ? glsl_double::sheenValue(o, i, alpha) *
                               std::max({1.0, glsl_double::sheenAlbedo(o.z, alpha),
                                         glsl_double::sheenAlbedo(i.z, alpha)})
                         : 0.0;
      }));
      EXPECT_NEAR(sheenAlbedoTable().at(float(z), float(alpha)), integral, 0.004)
          << "roughness " << roughness << ", cosine " << z;
    }
  }
}

TEST(SheenAlbedo, IsAboveOneOnlyAtGrazingAnglesOfLowRoughness) {
  const EnergyTable& table = sheenAlbedoTable();
  for (int k = 0; k <= 100; ++k) {
    const float cosine = float(k) / 100.0f;
    EXPECT_LE(table.at(cosine, 0.3f * 0.3f), 1.0f);
    EXPECT_LE(table.at(cosine, 1.0f), 1.0f);
  }
  EXPECT_GT(table.at(0.01f, 0.1f * 0.1f), 1.5f);
}

}  // namespace
}  // namespace fragtrace
