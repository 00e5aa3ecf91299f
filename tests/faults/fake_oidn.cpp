// SPDX-License-Identifier: MIT
// A stand-in for Open Image Denoise 2 whose output can be reckoned and which fails where it is told to:
// FAKE_OIDN is one of the words below. It adds up what it gets: a picture becomes color + 2 albedo + 2
// normal, and albedo and normal become half of themselves first, so color + albedo + normal shows that all
// came as they should.
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <map>
#include <string>

namespace {

struct Device {
  int error = 0;
  std::string message;
};

struct Filter {
  Device* device = nullptr;
  std::map<std::string, float*> images;
  std::map<std::string, int> numbers;
  size_t floats = 0;
  bool committed = false;
  bool (*monitor)(void*, double) = nullptr;
  void* user = nullptr;
};

bool isTold(const char* word) {
  const char* told = std::getenv("FAKE_OIDN");
  return told != nullptr && std::strcmp(told, word) == 0;
}

void fail(Device* device, int error, const char* message) {
  device->error = error;
  device->message = message;
}

/// Continues until it is stopped, or gives up.
void runUntilStopped(Filter* filter) {
  std::raise(SIGINT);
  if (isTold("interrupted-twice")) std::raise(SIGTERM);
  for (int i = 0; i < 1000; ++i) {
    if (!filter->monitor(filter->user, 0.5)) return fail(filter->device, 6, "execution was cancelled");
    const timespec wait{0, 10'000'000};
    nanosleep(&wait, nullptr);
  }
  fail(filter->device, 1, "nobody has stopped it");
}

/// Returns what is missing among the settings that every filter of this library must have.
const char* complaint(const Filter& filter) {
  const auto has = [&](const char* name) { return filter.images.count(name) == 1; };
  const auto number = [&](const char* name) {
    const auto found = filter.numbers.find(name);
    return found == filter.numbers.end() ? 0 : found->second;
  };
  if (!filter.committed) return "the filter is not committed";
  if (!has("output")) return "no output";
  if (number("quality") != 6) return "the quality is not high";
  if (number("maxMemoryMB") < 1 || number("maxMemoryMB") > 2000) return "maxMemoryMB is out of range";
  if (has("color") != (number("hdr") == 1)) return "hdr is not as it should be";
  if ((has("color") && has("albedo") && has("normal")) != (number("cleanAux") == 1))
    return "cleanAux is not as it should be";
  return nullptr;
}

}  // namespace

extern "C" {

Device* oidnNewDevice(int type) { return isTold("no-device") || type != 1 ? nullptr : new Device; }

void oidnCommitDevice(Device* device) {
  if (isTold("commit-device")) fail(device, 5, "unsupported processor");
}

int oidnGetDeviceError(Device* device, const char** message) {
  static std::string said;
  const int error = device == nullptr ? 5 : device->error;
  said = device == nullptr ? "no device of that kind" : device->message;
  if (device != nullptr) device->error = 0;
  if (message != nullptr) *message = error == 0 ? nullptr : said.c_str();
  return error;
}

int oidnGetDeviceInt(Device*, const char* name) {
  const std::string asked = name;
  if (asked == "versionMajor") return isTold("version") ? 3 : 2;
  return asked == "versionMinor" ? 77 : 1;
}

void oidnReleaseDevice(Device* device) { delete device; }

Filter* oidnNewFilter(Device* device, const char* type) {
  if (isTold("no-filter") || std::strcmp(type, "RT") != 0) {
    fail(device, 2, "no filter of that kind");
    return nullptr;
  }
  Filter* filter = new Filter;
  filter->device = device;
  return filter;
}

void oidnSetSharedFilterImage(Filter* filter, const char* name, void* pixels, int format, size_t width,
                              size_t height, size_t, size_t, size_t) {
  if (format != 3) fail(filter->device, 2, "the format is not three floats");
  filter->images[name] = static_cast<float*>(pixels);
  filter->floats = 3 * width * height;
}

void oidnSetFilterBool(Filter* filter, const char* name, bool value) {
  filter->numbers[name] = value ? 1 : 0;
}
void oidnSetFilterInt(Filter* filter, const char* name, int value) { filter->numbers[name] = value; }

void oidnSetFilterProgressMonitorFunction(Filter* filter, bool (*monitor)(void*, double), void* user) {
  filter->monitor = monitor;
  filter->user = user;
}

void oidnCommitFilter(Filter* filter) {
  filter->committed = true;
  if (isTold("commit")) fail(filter->device, 4, "not enough memory for the weights");
}

void oidnExecuteFilter(Filter* filter) {
  if (const char* wrong = complaint(*filter)) return fail(filter->device, 3, wrong);
  if (isTold("execute")) return fail(filter->device, 4, "out of memory in a layer");
  if (isTold("interrupted") || isTold("interrupted-twice")) return runUntilStopped(filter);
  float* const output = filter->images["output"];
  const bool isPicture = filter->images.count("color") == 1;
  for (size_t i = 0; i < filter->floats; ++i) {
    float sum = 0.0f;
    for (const auto& [name, pixels] : filter->images) {
      if (name != "output") sum += pixels[i] * (!isPicture ? 0.5f : name == "color" ? 1.0f : 2.0f);
    }
    output[i] = isTold("nan") ? 0.0f / (sum - sum) : sum;
  }
}

void oidnReleaseFilter(Filter* filter) { delete filter; }

}  // extern "C"
