// SPDX-License-Identifier: MIT
// The ways the program can fail; each kind has its exit status, each message names the file and the place.
#pragma once

#include <stdexcept>
#include <string>
#include <system_error>

namespace fragtrace {

/// The system's words for an errno.
inline std::string systemReason(int code) { return std::generic_category().message(code); }

/// Rendering, comparing or writing failed: exit status 1.
struct RenderError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The driver has lost the OpenGL context with all that was in it: another one may work.
struct ContextLost : RenderError {
  using RenderError::RenderError;
};

/// The command line is wrong: exit status 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// An option names something that this file does not have, and another file may have.
struct NotInFile : UsageError {
  using UsageError::UsageError;
};

/// A scene, environment or picture cannot be read: exit status 3.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// No OpenGL 4.5 context (or no display) can be had: exit status 4.
struct ContextError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Memory beyond the limit or a file outside of the scene's folder is asked for (SECURITY.md): the whole file
/// is refused, not only the part that asks.
struct AtStake : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace fragtrace
