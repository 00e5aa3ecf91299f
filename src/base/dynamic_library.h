// SPDX-License-Identifier: MIT
#pragma once

#include <dlfcn.h>

#include <initializer_list>
#include <string>

namespace fragtrace {

/// A shared library, opened by the first of its names that works. It stays open, since drivers do not survive
/// dlclose().
class DynamicLibrary {
 public:
  explicit DynamicLibrary(std::initializer_list<const char*> names) {
    for (const char* name : names) {
      if (handle_) break;
      handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
      const char* reason = dlerror();
      if (error_.empty()) error_ = reason ? reason : "cannot be opened";
    }
  }
  bool loaded() const { return handle_ != nullptr; }
  /// The reason why the first of the names could not be opened.
  const std::string& error() const { return error_; }

  /// Sets function to the symbol of that name; false when there is no such symbol.
  template <typename Function>
  bool find(const char* name, Function& function) const {
    function = reinterpret_cast<Function>(dlsym(handle_, name));
    return function != nullptr;
  }

 private:
  void* handle_ = nullptr;
  std::string error_;
};

/// Functions of a library, as members that find() initialises: `int (*f)(int) = find("f");`.
class LibraryFunctions {
 public:
  explicit LibraryFunctions(const DynamicLibrary& library) : library_(library) {}
  /// Returns true if the library is there, and has all of them.
  bool complete() const { return library_.loaded() && missing_ == nullptr; }
  /// The first that it lacks.
  const char* missing() const { return missing_; }

 protected:
  struct Symbol {
    void* address = nullptr;
    template <typename Function>
    operator Function*() const {
      return reinterpret_cast<Function*>(address);
    }
  };
  Symbol find(const char* name) {
    Symbol symbol;
    if (library_.loaded() && !library_.find(name, symbol.address) && missing_ == nullptr) missing_ = name;
    return symbol;
  }

 private:
  DynamicLibrary library_;
  const char* missing_ = nullptr;
};

}  // namespace fragtrace
