// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace fragtrace {

/// Collects the driver's messages through KHR_debug while it lives (errors always; in debug builds everything
/// above notifications). Call take() where the messages can be shown.
class DebugLog {
 public:
  DebugLog();
  DebugLog(const DebugLog&) = delete;
  DebugLog& operator=(const DebugLog&) = delete;
  ~DebugLog();
  std::vector<std::string> take();

 private:
  std::vector<std::string> messages_;
};

/// Does the same as checkGl(), with the driver's message about the error.
void checkGl(const char* where, DebugLog& log);

}  // namespace fragtrace
