// SPDX-License-Identifier: MIT
#include "base/spawn.h"

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

namespace fragtrace {

int spawnProcess(const std::string& program, std::vector<std::string> words,
                 const std::vector<std::pair<int, int>>& files, pid_t& process) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  for (const auto& [there, ours] : files) {
    if (ours == kNoFile)
      posix_spawn_file_actions_addopen(&actions, there, "/dev/null",
                                       there == STDIN_FILENO ? O_RDONLY : O_WRONLY, 0);
    else
      posix_spawn_file_actions_adddup2(&actions, ours, there);
  }
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  const int error =
      ::posix_spawnp(&process, program.c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  return error;
}

}  // namespace fragtrace
