// SPDX-License-Identifier: MIT
#include "base/worker/leaves_first.h"

#include <dlfcn.h>
#include <elf.h>
#include <fcntl.h>
#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace fragtrace {

namespace {

/// The names after DT_NEEDED in a file of this machine's ELF class; none in other files.
std::vector<std::string> neededOf(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return {};
  const off_t size = ::lseek(file, 0, SEEK_END);
  void* const memory =
      size <= 0 ? MAP_FAILED : ::mmap(nullptr, size_t(size), PROT_READ, MAP_PRIVATE, file, 0);
  ::close(file);
  if (memory == MAP_FAILED) return {};
  const std::span bytes(static_cast<const char*>(memory), size_t(size));
  const auto table = [&]<typename Entry>(size_t offset, size_t count) {
    const bool isInside = offset % alignof(Entry) == 0 && offset <= bytes.size() &&
                          count <= (bytes.size() - offset) / sizeof(Entry);
    return std::span(reinterpret_cast<const Entry*>(bytes.data() + offset), isInside ? count : 0);
  };
  std::vector<std::string> names;
  for (const auto& header : table.operator()<ElfW(Ehdr)>(0, 1)) {
    if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0) break;
    const auto segments = table.operator()<ElfW(Phdr)>(header.e_phoff, header.e_phnum);
    const auto offsetOf = [&](ElfW(Addr) address) {
      for (const auto& s : segments) {
        if (s.p_type == PT_LOAD && address >= s.p_vaddr && address - s.p_vaddr < s.p_filesz)
          return size_t(address - s.p_vaddr + s.p_offset);
      }
      return bytes.size();
    };
    for (const auto& segment : segments) {
      if (segment.p_type != PT_DYNAMIC) continue;
      const auto entries =
          table.operator()<ElfW(Dyn)>(segment.p_offset, segment.p_filesz / sizeof(ElfW(Dyn)));
      size_t strings = bytes.size();
      for (const auto& e : entries) strings = e.d_tag == DT_STRTAB ? offsetOf(e.d_un.d_ptr) : strings;
      for (const auto& e : entries) {
        if (e.d_tag != DT_NEEDED || e.d_un.d_val >= bytes.size() - strings) continue;
        const auto name = bytes.subspan(strings + e.d_un.d_val);
        names.emplace_back(name.data(), ::strnlen(name.data(), name.size()));
      }
    }
  }
  ::munmap(memory, size_t(size));
  return names;
}

/// The library in that folder. Debian's libblas.so.3 and liblapack.so.3 are links by /etc/alternatives, which
/// sandboxes lack, to files in folders of their own, blas and lapack.
std::filesystem::path libraryIn(const std::filesystem::path& folder, const std::string& name) {
  std::error_code error;
  if (std::filesystem::exists(folder / name, error) || !name.starts_with("lib")) return folder / name;
  const size_t begin = std::strlen("lib");
  return folder / name.substr(begin, name.find(".so") - begin) / name;
}

void loadNeeded(const std::filesystem::path& object, const std::filesystem::path& folder,
                std::set<std::string>& seen) {
  for (const std::string& name : neededOf(object)) {
    if (!seen.insert(name).second) continue;
    const std::filesystem::path library = libraryIn(folder, name);
    loadNeeded(library, folder, seen);
    // All symbols at once: what only the whole can resolve fails here, not in use.
    ::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  }
}

}  // namespace

void loadLeavesFirst(const std::filesystem::path& object) {
  Dl_info library{};
  std::error_code error;
  if (::dladdr(reinterpret_cast<const void*>(&::strnlen), &library) == 0) return;
  const auto folder = std::filesystem::canonical(library.dli_fname, error).parent_path();
  std::set<std::string> seen;
  loadNeeded(object, folder, seen);
}

}  // namespace fragtrace
