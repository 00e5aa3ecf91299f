// SPDX-License-Identifier: MIT
// Speaks to the session's bus by the functions of sd-bus that this takes. The library is opened when a dialog
// is asked for first.
#include "view/window/file_dialog.h"

#include <cctype>
#include <cstdint>
#include <limits>
#include <memory>
#include <string_view>

#include "base/dynamic_library.h"
#include "base/errors.h"

namespace fragtrace {

namespace {

using Bus = struct SdBus*;
using BusMessage = struct SdBusMessage*;
/// sd_bus_error of sd-bus.h.
struct BusError {
  const char* name = nullptr;
  const char* message = nullptr;
  int mustFree = 0;
};

constexpr const char* kPortal = "org.freedesktop.portal.Desktop";
constexpr const char* kPortalPath = "/org/freedesktop/portal/desktop";
constexpr const char* kChooser = "org.freedesktop.portal.FileChooser";
constexpr const char* kRequest = "org.freedesktop.portal.Request";
constexpr const char* kResponses =
    "type='signal',sender='org.freedesktop.portal.Desktop',"
    "interface='org.freedesktop.portal.Request',member='Response'";
constexpr uint64_t kPatience =
    // Microseconds for a call: the portal answers at once whether it will show a dialog.
    2000000;
constexpr uint64_t kLook = 50000;   // microseconds between two looks at whether the question is cancelled
constexpr uint32_t kCancelled = 1;  // a response of the portal; 0: chosen

struct BusLibrary : LibraryFunctions {
  using LibraryFunctions::LibraryFunctions;
  int (*openUser)(Bus* bus) = find("sd_bus_open_user");
  Bus (*flushCloseUnref)(Bus bus) = find("sd_bus_flush_close_unref");
  int (*setTimeout)(Bus bus, uint64_t microseconds) = find("sd_bus_set_method_call_timeout");
  int (*process)(Bus bus, BusMessage* message) = find("sd_bus_process");
  int (*wait)(Bus bus, uint64_t microseconds) = find("sd_bus_wait");
  int (*call)(Bus bus, BusMessage message, uint64_t microseconds, BusError* error,
              BusMessage* reply) = find("sd_bus_call");
  int (*callMethod)(Bus bus, const char* destination, const char* path, const char* interface,
                    const char* member, BusError* error, BusMessage* reply, const char* types,
                    ...) = find("sd_bus_call_method");
  void (*freeError)(BusError* error) = find("sd_bus_error_free");
  int (*newCall)(Bus bus, BusMessage* message, const char* destination, const char* path,
                 const char* interface, const char* member) = find("sd_bus_message_new_method_call");
  BusMessage (*unref)(BusMessage message) = find("sd_bus_message_unref");
  int (*append)(BusMessage message, const char* types, ...) = find("sd_bus_message_append");
  int (*appendArray)(BusMessage message, char type, const void* data,
                     size_t bytes) = find("sd_bus_message_append_array");
  int (*open)(BusMessage message, char type, const char* contents) = find("sd_bus_message_open_container");
  int (*close)(BusMessage message) = find("sd_bus_message_close_container");
  int (*isSignal)(BusMessage message, const char* interface,
                  const char* member) = find("sd_bus_message_is_signal");
  const char* (*pathOf)(BusMessage message) = find("sd_bus_message_get_path");
  int (*read)(BusMessage message, const char* types, ...) = find("sd_bus_message_read");
  int (*enter)(BusMessage message, char type, const char* contents) = find("sd_bus_message_enter_container");
  int (*exit)(BusMessage message) = find("sd_bus_message_exit_container");
  int (*skip)(BusMessage message, const char* types) = find("sd_bus_message_skip");
};

const BusLibrary& sdBus() {
  static const DynamicLibrary library({"libsystemd.so.0", "libelogind.so.0"});
  static const BusLibrary functions(library);
  return functions;
}

/// A connection to the session's bus. The destructor closes it; then the portal closes the dialog, too.
struct Connection {
  Bus bus = nullptr;

  Connection() {
    if (sdBus().openUser(&bus) < 0) bus = nullptr;
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() {
    if (bus) sdBus().flushCloseUnref(bus);
  }
};

/// A message, let go when it goes.
struct Held {
  BusMessage message = nullptr;

  Held() = default;
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
  ~Held() {
    if (message) sdBus().unref(message);
  }
};

/// Why a call failed; empty where nobody was there to answer it.
std::string reasonOf(int result, BusError& error) {
  std::string reason = systemReason(-result);
  if (error.name != nullptr) {
    const std::string_view name = error.name;
    const bool nobody = name == "org.freedesktop.DBus.Error.ServiceUnknown" ||
                        name == "org.freedesktop.DBus.Error.NameHasNoOwner" ||
                        name == "org.freedesktop.DBus.Error.UnknownMethod" ||
                        name == "org.freedesktop.DBus.Error.UnknownInterface";
    reason = nobody ? "" : error.message != nullptr ? error.message : error.name;
  }
  sdBus().freeError(&error);
  return reason;
}

/// Returns a pattern that matches an extension in any case: "*.[gG][lL][bB]".
std::string patternOf(const std::string& extension) {
  std::string pattern = "*";
  for (const char c : extension) {
    const auto code = static_cast<unsigned char>(c);
    if (std::isalpha(code) != 0)
      pattern += {'[', char(std::tolower(code)), char(std::toupper(code)), ']'};
    else
      pattern += c;
  }
  return pattern;
}

/// The option "filters", of type a(sa(us)).
void appendFilters(BusMessage message, const std::vector<FileFilter>& filters) {
  sdBus().open(message, 'e', "sv");
  sdBus().append(message, "s", "filters");
  sdBus().open(message, 'v', "a(sa(us))");
  sdBus().open(message, 'a', "(sa(us))");
  for (const FileFilter& filter : filters) {
    sdBus().open(message, 'r', "sa(us)");
    sdBus().append(message, "s", filter.name.c_str());
    sdBus().open(message, 'a', "(us)");
    for (const std::string& extension : filter.extensions)
      sdBus().append(message, "(us)", uint32_t(0), patternOf(extension).c_str());
    sdBus().close(message);
    sdBus().close(message);
  }
  sdBus().close(message);
  sdBus().close(message);
  sdBus().close(message);
}

/// The option "current_folder": bytes that end with a 0.
void appendFolder(BusMessage message, const std::string& folder) {
  sdBus().open(message, 'e', "sv");
  sdBus().append(message, "s", "current_folder");
  sdBus().open(message, 'v', "ay");
  sdBus().appendArray(message, 'y', folder.c_str(), folder.size() + 1);
  sdBus().close(message);
  sdBus().close(message);
}

/// The desktop has shown no dialog, and why; empty: there is no portal.
struct NoDialog {
  std::string why{};
};

/// Asks for the dialog. Returns the path of the request. Throws NoDialog.
std::string request(const Connection& to, const FileQuestion& question, const std::string& window) {
  BusError error;
  Held call;
  Held reply;
  int result = sdBus().newCall(to.bus, &call.message, kPortal, kPortalPath, kChooser,
                               question.save ? "SaveFile" : "OpenFile");
  if (result >= 0) {
    sdBus().append(call.message, "ss", window.c_str(), question.title.c_str());
    sdBus().open(call.message, 'a', "{sv}");
    appendFilters(call.message, question.filters);
    appendFolder(call.message, question.folder.string());
    if (question.save) sdBus().append(call.message, "{sv}", "current_name", "s", question.name.c_str());
    // An append that failed before fails here.
    result = sdBus().close(call.message);
  }
  if (result >= 0) result = sdBus().call(to.bus, call.message, kPatience, &error, &reply.message);
  const char* path = "";
  if (result >= 0) result = sdBus().read(reply.message, "o", &path);
  if (result < 0) throw NoDialog{reasonOf(result, error)};
  return path;
}

/// The first of the URIs in a response.
std::string readUri(BusMessage response) {
  const char* uri = "";
  if (sdBus().enter(response, 'a', "{sv}") < 0) return "";
  while (sdBus().enter(response, 'e', "sv") > 0) {
    const char* key = "";
    if (sdBus().read(response, "s", &key) < 0) return "";
    if (std::string_view(key) == "uris") {
      if (sdBus().enter(response, 'v', "as") < 0 || sdBus().enter(response, 'a', "s") < 0 ||
          sdBus().read(response, "s", &uri) < 0)
        return "";
      return uri;
    }
    if (sdBus().skip(response, "v") < 0 || sdBus().exit(response) < 0) return "";
  }
  return "";
}

constexpr double kPatienceSeconds = 1.5;  // before the user is told what is waited for

/// Shows the dialog and waits until the user has answered, or the job is cancelled: then the dialog is
/// closed. Returns the URI of the choice; empty: none. Throws NoDialog.
std::string chosenUri(const FileQuestion& question, const std::string& window, const BackgroundJob& job) {
  if (!sdBus().complete()) throw NoDialog();
  const Connection to;
  if (!to.bus) throw NoDialog();
  sdBus().setTimeout(to.bus, kPatience);
  BusError error;
  const int result = sdBus().callMethod(to.bus, "org.freedesktop.DBus", "/org/freedesktop/DBus",
                                        "org.freedesktop.DBus", "AddMatch", &error, nullptr, "s", kResponses);
  if (result < 0) throw NoDialog{reasonOf(result, error)};
  const std::string path = request(to, question, window);
  while (!job.cancelled()) {
    Held message;
    const int processed = sdBus().process(to.bus, &message.message);
    if (processed < 0) throw NoDialog{"the bus has ended"};
    if (processed == 0) sdBus().wait(to.bus, kLook);
    if (!message.message || sdBus().isSignal(message.message, kRequest, "Response") <= 0) continue;
    if (sdBus().pathOf(message.message) != path) continue;
    uint32_t code = 0;
    if (sdBus().read(message.message, "u", &code) < 0) throw NoDialog{"it answers with nonsense"};
    if (code > kCancelled) throw NoDialog{"its dialog has ended"};
    return code == 0 ? readUri(message.message) : "";
  }
  sdBus().callMethod(to.bus, kPortal, path.c_str(), kRequest, "Close", &error, nullptr, "");
  sdBus().freeError(&error);
  return "";
}

FileDialog::Answer answerOf(const FileQuestion& question, const std::string& window,
                            const BackgroundJob& job) {
  try {
    const std::string uri = chosenUri(question, window, job);
    const std::optional<std::filesystem::path> file = fileOfUri(uri);
    if (file || uri.empty()) return {file.value_or(std::filesystem::path()), {}};
    return {{}, uri + " is not a file of this computer"};
  } catch (const NoDialog& none) {
    const std::string why =
        "the desktop shows no dialog for files" + (none.why.empty() ? "" : ": " + none.why);
    if (question.save) return {question.folder / question.name, why + "; the file gets a free name"};
    return {{}, why + "; drop a file here, start with its name, or install xdg-desktop-portal-gtk"};
  }
}

}  // namespace

void FileDialog::ask(FileQuestion question, const std::string& window, double now) {
  question_ = std::move(question);
  asked_ = now;
  desktop_.start("portal", [question = question_, window](const BackgroundJob& job) {
    return answerOf(question, window, job);
  });
}

FileDialog::Answer FileDialog::take(double now) {
  if (std::optional<Answer> answer = desktop_.take()) return *answer;
  if (!desktop_.busy() || now <= asked_ + kPatienceSeconds) return {};
  asked_ = std::numeric_limits<double>::infinity();
  return {{}, "waiting for the desktop's dialog; press the key again for another one"};
}

}  // namespace fragtrace
