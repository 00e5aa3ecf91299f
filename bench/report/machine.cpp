// SPDX-License-Identifier: MIT
#include "bench/report/machine.h"

#include <array>
#include <ctime>
#include <fstream>
#include <thread>

namespace fragtrace {

namespace {

/// Returns the processor's name as Linux reports it, or an empty text on other systems.
std::string processorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return {};
}

std::string utcNow() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

}  // namespace

BenchMachine describeMachine(const Context& context) {
  BenchMachine machine;
  machine.processor = processorName();
  machine.cores = int(std::thread::hardware_concurrency());
  machine.glRenderer = context.renderer;
  machine.glVersion = context.version;
  machine.backend = context.backend;
  machine.program = std::string("fragtrace ") + FRAGTRACE_VERSION;
  machine.date = utcNow();
  return machine;
}

}  // namespace fragtrace
