// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace fragtrace {

/// Loads the libraries that a shared object needs, the innermost first, before somebody loads the object. The
/// dynamic linker looks each symbol up in all libraries that one dlopen() brings. OpenImageIO of Debian 12
/// brings 260: in this order they are loaded in 0.10 s of processor time, not in 0.23 s. Only libraries in
/// the folder of the C library are loaded; one that cannot be loaded alone is left to the object.
void loadLeavesFirst(const std::filesystem::path& object);

}  // namespace fragtrace
