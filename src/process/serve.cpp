// SPDX-License-Identifier: MIT
#include "process/serve.h"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>

namespace fragtrace {

bool isStartedByProgram(const char* processName) {
  struct stat status {};
  if (::fstat(kServiceSocket, &status) == 0 && S_ISSOCK(status.st_mode)) return true;
  std::fprintf(stderr, "%s: started by fragtrace, not by hand\n", processName);
  return false;
}

RequestMemory::RequestMemory(int file, uint64_t size) : size_(size) {
  void* memory = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  ::close(file);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  bytes_ = static_cast<uint8_t*>(memory);
}

RequestMemory::~RequestMemory() { ::munmap(bytes_, size_); }

void setReason(std::span<char> room, const char* reason) {
  std::strncpy(room.data(), reason, room.size() - 1);
}

}  // namespace fragtrace
