// SPDX-License-Identifier: MIT
#include "image/denoise/oidn_library.h"

#include <dlfcn.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <system_error>
#include <vector>

#include "base/errors.h"

namespace fragtrace {

namespace {

constexpr const char* kOidnName = "libOpenImageDenoise.so.2";
constexpr const char* kOidnVariable = "FRAGTRACE_OIDN_LIBRARY";
constexpr int kOidnMajor = 2;

std::string textOfVariable(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? "" : text;
}

/// Folders of Python packages: those of an environment, of the user and of the system.
std::vector<std::filesystem::path> packageFolders() {
  std::vector<std::filesystem::path> folders;
  const auto addVersions = [&](const std::filesystem::path& library, const char* packages) {
    std::error_code error;
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator(library, error)) {
      if (entry.path().filename().string().starts_with("python3")) found.push_back(entry.path() / packages);
    }
    std::ranges::sort(found);
    folders.insert(folders.end(), found.begin(), found.end());
  };
  const std::filesystem::path environment = textOfVariable("VIRTUAL_ENV");
  const std::filesystem::path home = textOfVariable("HOME");
  if (!environment.empty()) addVersions(environment / "lib", "site-packages");
  if (!home.empty()) addVersions(home / ".local/lib", "site-packages");
  addVersions("/usr/local/lib", "dist-packages");
  folders.emplace_back("/usr/lib/python3/dist-packages");
  return folders;
}

/// The error of the dynamic loader since the last call.
std::string loaderError() {
  const char* reason = dlerror();
  return reason == nullptr ? "cannot be opened" : reason;
}

/// Null when a file cannot be opened, and why.
void* openOidnFile(const std::filesystem::path& path, std::string& reason) {
  std::error_code error;
  // The loader waits for whoever writes to a pipe.
  if (!std::filesystem::is_regular_file(path, error)) {
    reason =
        path.string() + (std::filesystem::exists(path, error) ? ": is no file" : ": there is no such file");
    return nullptr;
  }
  void* handle = dlopen(std::filesystem::absolute(path).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) reason = loaderError();
  return handle;
}

template <typename Function>
void findOidnFunction(void* handle, const std::string& file, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(handle, name));
  if (function == nullptr) throw UsageError(file + ": is no Open Image Denoise 2: it lacks " + name);
}

OidnFunctions findOidnFunctions(void* handle, const std::string& file) {
  OidnFunctions call{};
  const auto find = [&](const char* name, auto& function) { findOidnFunction(handle, file, name, function); };
  find("oidnNewDevice", call.newDevice);
  find("oidnCommitDevice", call.commitDevice);
  find("oidnGetDeviceError", call.getDeviceError);
  find("oidnGetDeviceInt", call.getDeviceInt);
  find("oidnReleaseDevice", call.releaseDevice);
  find("oidnNewFilter", call.newFilter);
  find("oidnSetSharedFilterImage", call.setSharedFilterImage);
  find("oidnSetFilterBool", call.setFilterBool);
  find("oidnSetFilterInt", call.setFilterInt);
  find("oidnSetFilterProgressMonitorFunction", call.setProgressMonitor);
  find("oidnCommitFilter", call.commitFilter);
  find("oidnExecuteFilter", call.executeFilter);
  find("oidnReleaseFilter", call.releaseFilter);
  return call;
}

/// Makes the device, which knows the version.
OidnLibrary startOidn(void* handle, const std::string& file) {
  OidnLibrary library;
  library.call = findOidnFunctions(handle, file);
  library.file = file;
  const auto checkStarted = [&] {
    const char* message = nullptr;
    if (library.call.getDeviceError(library.device.get(), &message) == kOidnNoError && library.device) return;
    throw UsageError(file + ": Open Image Denoise does not start: " +
                     (message == nullptr ? "it makes no device" : message));
  };
  library.device = {library.call.newDevice(kOidnCpuDevice),
                    [release = library.call.releaseDevice](OidnDeviceHandle* device) {
                      if (device != nullptr) release(device);
                    }};
  checkStarted();
  // The version is read before the device is used, because the calls below are known for version 2 only.
  const auto number = [&](const char* name) { return library.call.getDeviceInt(library.device.get(), name); };
  const int major = number("versionMajor");
  library.version = std::to_string(major) + "." + std::to_string(number("versionMinor")) + "." +
                    std::to_string(number("versionPatch"));
  if (major != kOidnMajor)
    throw UsageError(file + ": is Open Image Denoise " + library.version + ", where 2.x is needed");
  library.call.commitDevice(library.device.get());
  checkStarted();
  return library;
}

OidnLibrary openNamedOidn(const std::filesystem::path& path, const std::string& saidBy) {
  std::string reason;
  void* handle = openOidnFile(path, reason);
  if (handle == nullptr) throw UsageError(saidBy + ": cannot be opened as a library: " + reason);
  return startOidn(handle, path.string());
}

OidnLibrary openAnyOidn() {
  if (void* handle = dlopen(kOidnName, RTLD_NOW | RTLD_LOCAL)) return startOidn(handle, kOidnName);
  std::string reasons;
  for (const std::filesystem::path& folder : packageFolders()) {
    const std::filesystem::path path = folder / "pyoidn/oidn/lib" / kOidnName;
    std::error_code error;
    if (!std::filesystem::exists(path, error)) continue;
    std::string reason;
    if (void* handle = openOidnFile(path, reason)) return startOidn(handle, path.string());
    reasons += "; " + reason;
  }
  throw UsageError(std::string("Open Image Denoise is not there: neither ") + kOidnName +
                   " nor the Python package pyoidn was found (pip install pyoidn, or name the file by "
                   "--oidn-library or " +
                   kOidnVariable + ")" + reasons);
}

}  // namespace

bool namesOidn(const std::filesystem::path& chosen) {
  return !chosen.empty() || !textOfVariable(kOidnVariable).empty();
}

OidnLibrary openOidn(const std::filesystem::path& chosen) {
  const auto start = std::chrono::steady_clock::now();
  const std::string byVariable = textOfVariable(kOidnVariable);
  OidnLibrary library = !chosen.empty()       ? openNamedOidn(chosen, "--oidn-library")
                        : !byVariable.empty() ? openNamedOidn(byVariable, kOidnVariable)
                                              : openAnyOidn();
  library.loadMs =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return library;
}

}  // namespace fragtrace
