// SPDX-License-Identifier: MIT
#include "image/worker/messages.h"

#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace fragtrace {
namespace {

/// A message of one request that carries one descriptor (man unix, SCM_RIGHTS).
struct Message {
  iovec body{};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  msghdr header{};

  explicit Message(ImageRequest& request) : body{&request, sizeof request} {
    header.msg_iov = &body;
    header.msg_iovlen = 1;
    header.msg_control = control;
    header.msg_controllen = sizeof control;
  }
};

}  // namespace

std::vector<uint8_t> packTexts(const std::vector<std::string>& texts) {
  std::vector<uint8_t> bytes;
  for (const std::string& text : texts) {
    const auto length = uint32_t(text.size());
    const size_t at = bytes.size();
    bytes.resize(at + sizeof length + text.size());
    std::memcpy(bytes.data() + at, &length, sizeof length);
    std::memcpy(bytes.data() + at + sizeof length, text.data(), text.size());
  }
  return bytes;
}

std::vector<std::string> unpackTexts(std::span<const uint8_t> bytes) {
  std::vector<std::string> texts;
  while (!bytes.empty()) {
    uint32_t length = 0;
    if (bytes.size() < sizeof length) throw std::runtime_error("the image process sent broken texts");
    std::memcpy(&length, bytes.data(), sizeof length);
    bytes = bytes.subspan(sizeof length);
    if (length > bytes.size()) throw std::runtime_error("the image process sent broken texts");
    texts.emplace_back(reinterpret_cast<const char*>(bytes.data()), length);
    bytes = bytes.subspan(length);
  }
  return texts;
}

bool sendRequest(int socket, const ImageRequest& request, int memoryFile) {
  ImageRequest copy = request;
  Message message(copy);
  cmsghdr* control = CMSG_FIRSTHDR(&message.header);
  control->cmsg_level = SOL_SOCKET;
  control->cmsg_type = SCM_RIGHTS;
  control->cmsg_len = CMSG_LEN(sizeof memoryFile);
  std::memcpy(CMSG_DATA(control), &memoryFile, sizeof memoryFile);
  ssize_t sent = -1;
  do {
    sent = ::sendmsg(socket, &message.header, MSG_NOSIGNAL);
  } while (sent < 0 && errno == EINTR);
  return sent == ssize_t(sizeof request);
}

std::optional<ImageRequest> receiveRequest(int socket, int& memoryFile) {
  ImageRequest request;
  Message message(request);
  ssize_t received = -1;
  do {
    received = ::recvmsg(socket, &message.header, MSG_CMSG_CLOEXEC);
  } while (received < 0 && errno == EINTR);
  const cmsghdr* control = CMSG_FIRSTHDR(&message.header);
  if (received != ssize_t(sizeof request) || control == nullptr) return std::nullopt;
  std::memcpy(&memoryFile, CMSG_DATA(control), sizeof memoryFile);
  return request;
}

}  // namespace fragtrace
