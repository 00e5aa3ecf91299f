// SPDX-License-Identifier: MIT
// property_test BACKEND FIRST COUNT [FORM]: scenes of the seeds FIRST, FIRST + 1, ... are drawn as they are
// and in an equivalent form (tests/instruments/stress/forms.h), which must show the same. Seed s takes form s
// / 6 % 7 unless one is named. A scene that does not is printed with its seed and form: `property_test egl
// SEED 1 FORM` draws it again.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>

#include "osmesa.h"
#include "tests/instruments/stress/likeness.h"
#include "tests/instruments/stress/random_sketch.h"

namespace fragtrace {
namespace {

Form formOf(uint32_t seed, const char* name) {
  if (name == nullptr) return Form(seed / kSketchKinds % kFormNames.size());
  for (size_t i = 0; i < kFormNames.size(); ++i) {
    if (kFormNames[i] == name) return Form(i);
  }
  std::fprintf(stderr, "%s is no form\n", name);
  std::exit(2);
}

int run(const char* backend, uint32_t first, uint32_t count, const char* form) {
  constexpr double kMostOtherHits = 1e-3;
  const bool osMesa = std::strcmp(backend, "osmesa") == 0;
  if (osMesa && !hasOsMesa()) {
    std::printf("skipped: libOSMesa is not installed\n");
    return kSkipped;
  }
  DeviceOptions device;
  device.backend = osMesa ? Backend::OsMesa : Backend::Egl;
  const auto context = makeContext(device);
  const bool verbose = count == 1;
  size_t wrong = 0;
  size_t pixels = 0;
  size_t otherHits = 0;
  for (uint32_t seed = first; seed < first + count; ++seed) {
    // Each form by both schedules.
    const Schedule schedule = seed / kFormNames.size() % 2 == 0 ? Schedule::Megakernel : Schedule::Wavefront;
    const Likeness likeness = likenessOf(*context, seed, formOf(seed, form), schedule, [] {});
    if (verbose || !likeness.wrong.empty() || likeness.otherHits > 0)
      std::printf("%s\n", likenessLine(likeness).c_str());
    wrong += !likeness.wrong.empty();
    pixels += likeness.pixels;
    otherHits += likeness.otherHits;
  }
  std::printf("%zu of %u scenes differ; %zu of %zu hits are other, at most %g of them may be\n", wrong, count,
              otherHits, pixels, kMostOtherHits);
  return wrong > 0 || double(otherHits) > kMostOtherHits * double(pixels) ? 1 : 0;
}

}  // namespace
}  // namespace fragtrace

int main(int count, char** arguments) {
  if (count < 4) return 2;
  try {
    return fragtrace::run(arguments[1], uint32_t(std::atoi(arguments[2])), uint32_t(std::atoi(arguments[3])),
                          count > 4 ? arguments[4] : nullptr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "property_test: %s\n", error.what());
    return 1;
  }
}
