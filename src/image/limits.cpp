// SPDX-License-Identifier: MIT
#include "image/limits.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>

#include "base/errors.h"

namespace fragtrace {
namespace {

std::string inMegabytes(uint64_t bytes) { return std::to_string((bytes + 999'999) / 1'000'000) + " MB"; }

}  // namespace

uint64_t defaultMemoryLimit() {
  uint64_t limit = uint64_t(8) << 30;
  const long pages = ::sysconf(_SC_PHYS_PAGES);
  const long pageSize = ::sysconf(_SC_PAGESIZE);
  if (pages > 0 && pageSize > 0) limit = std::min(limit, uint64_t(pages) * uint64_t(pageSize) / 2);
  rlimit address{};
  if (::getrlimit(RLIMIT_AS, &address) == 0 && address.rlim_cur != RLIM_INFINITY)
    limit = std::min(limit, uint64_t(address.rlim_cur));
  return limit;
}

void MemoryBudget::take(uint64_t bytes) {
  if (bytes > limit_ - taken_) {
    const uint64_t wanted = bytes > UINT64_MAX - taken_ ? UINT64_MAX : taken_ + bytes;
    throw AtStake("would take " + inMegabytes(wanted) + " of memory, more than the " + inMegabytes(limit_) +
                  " of --memory-limit");
  }
  taken_ += bytes;
}

}  // namespace fragtrace
