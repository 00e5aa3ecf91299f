// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "image/image.h"

namespace fragtrace {

// Notes for handlers of signals, which may call few functions.

/// Set before the first file takes its place, for a handler that says what is there.
inline volatile std::sig_atomic_t filesMayBeWritten = 0;

/// The path of the part that is being written, for a handler that removes it; empty if there is none.
inline std::array<char, 4096> partBeingWritten{};

// Files read and replaced as a whole.

/// Checks the first bytes of a file (64 KiB, or all of a shorter one) before more is read. `size` is the
/// file's, or 0 for a pipe. Returns the largest number of bytes to read; it may throw.
using BeginningCheck = std::function<uint64_t(std::span<const uint8_t> first, uint64_t size)>;

/// Told after every 16 MB, and at the end, how many bytes of how many (0: of a pipe) have been read; what it
/// throws ends reading.
using ReadProgress = std::function<void(uint64_t read, uint64_t size)>;

/// Reads all bytes of an open regular file or pipe, and closes it. Throws std::runtime_error with the bare
/// reason if it is something else, needs more than is left of `memory`, or cannot be read; `check` and
/// `progress` may throw, too.
std::vector<uint8_t> readOpenFile(int file, const MemoryBudget& memory, const BeginningCheck& check = {},
                                  const ReadProgress& progress = {});

/// Does the same of the file at a path, of at most `limit` bytes.
std::vector<uint8_t> readBytes(const std::filesystem::path& path, uint64_t limit,
                               const BeginningCheck& check = {}, const ReadProgress& progress = {});
/// Does the same, but throws InputError naming the path, too.
std::vector<uint8_t> readWholeFile(const std::filesystem::path& path, uint64_t limit = defaultMemoryLimit());

/// Files that are replaced many times a second need not outlive a power cut.
enum class Kept { OnDisk, Briefly };

/// Makes the file hold exactly these bytes: they are written to its part (partOf), which is then renamed,
/// so that anybody sees the old file or the new one, also after a power cut (Kept::OnDisk). On failure the
/// old file is untouched and the part removed. A symbolic link stays, the file that it leads to is replaced;
/// a device or a pipe is written to. Throws RenderError naming the path and the system's reason.
void replaceFile(const std::filesystem::path& path, std::span<const uint8_t> bytes, Kept kept = Kept::OnDisk);

/// This process's part of that file, for a program that writes it: .NAME.PROCESS-MACHINE.part next to what
/// symbolic links lead to. No two processes have one name, so that several may write the same file.
std::filesystem::path partOf(const std::filesystem::path& path);

enum class PartsOf { EndedProcesses, All };

/// Removes parts of that file that were left: those of this machine's processes that have ended, as
/// replaceFile() does, or all of a file that no other process writes.
void removeParts(const std::filesystem::path& path, PartsOf whose = PartsOf::EndedProcesses);

/// Puts the part in the file's place once the disk has it, or removes it and throws RenderError naming the
/// path and the reason.
void takePart(const std::filesystem::path& path);

/// Writes all bytes to standard output. Throws RenderError, also where its reader has gone.
void writeToStandardOutput(std::span<const uint8_t> bytes);

/// Throws what replaceFile would when the folder is missing or closed to us: to be asked before long work.
void checkReplaceable(const std::filesystem::path& path);

/// Throws the error that replaceFile would throw if there is no room for a file of `bytes` bytes, on the disk
/// or within ulimit -f.
void checkRoom(const std::filesystem::path& path, uint64_t bytes);

}  // namespace fragtrace
