// SPDX-License-Identifier: MIT
// Speaks to the session's bus by the functions of sd-bus that this takes. The library is opened when a dialog
// is asked for first.
#include "view/window/file_dialog.h"

#include <cctype>
#include <cstdint>
#include <limits>
#include <memory>
#include <string_view>

#include "base/errors.h"
#include "gl/dynamic_library.h"
#include "view/files.h"

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

struct BusLibrary {
  int (*openUser)(Bus* bus) = nullptr;
  Bus (*flushCloseUnref)(Bus bus) = nullptr;
  int (*setTimeout)(Bus bus, uint64_t microseconds) = nullptr;
  int (*process)(Bus bus, BusMessage* message) = nullptr;
  int (*wait)(Bus bus, uint64_t microseconds) = nullptr;
  int (*call)(Bus bus, BusMessage message, uint64_t microseconds, BusError* error,
              BusMessage* reply) = nullptr;
  int (*callMethod)(Bus bus, const char* destination, const char* path, const char* interface,
                    const char* member, BusError* error, BusMessage* reply, const char* types, ...) = nullptr;
  void (*freeError)(BusError* error) = nullptr;
  int (*newCall)(Bus bus, BusMessage* message, const char* destination, const char* path,
                 const char* interface, const char* member) = nullptr;
  BusMessage (*unref)(BusMessage message) = nullptr;
  int (*append)(BusMessage message, const char* types, ...) = nullptr;
  int (*appendArray)(BusMessage message, char type, const void* data, size_t bytes) = nullptr;
  int (*open)(BusMessage message, char type, const char* contents) = nullptr;
  int (*close)(BusMessage message) = nullptr;
  int (*isSignal)(BusMessage message, const char* interface, const char* member) = nullptr;
  const char* (*pathOf)(BusMessage message) = nullptr;
  int (*read)(BusMessage message, const char* types, ...) = nullptr;
  int (*enter)(BusMessage message, char type, const char* contents) = nullptr;
  int (*exit)(BusMessage message) = nullptr;
  int (*skip)(BusMessage message, const char* types) = nullptr;

  bool load(const DynamicLibrary& library) {
    return library.find("sd_bus_open_user", openUser) &&
           library.find("sd_bus_flush_close_unref", flushCloseUnref) &&
           library.find("sd_bus_set_method_call_timeout", setTimeout) &&
           library.find("sd_bus_process", process) && library.find("sd_bus_wait", wait) &&
           library.find("sd_bus_call", call) && library.find("sd_bus_call_method", callMethod) &&
           library.find("sd_bus_error_free", freeError) &&
           library.find("sd_bus_message_new_method_call", newCall) &&
           library.find("sd_bus_message_unref", unref) && library.find("sd_bus_message_append", append) &&
           library.find("sd_bus_message_append_array", appendArray) &&
           library.find("sd_bus_message_open_container", open) &&
           library.find("sd_bus_message_close_container", close) &&
           library.find("sd_bus_message_is_signal", isSignal) &&
           library.find("sd_bus_message_get_path", pathOf) && library.find("sd_bus_message_read", read) &&
           library.find("sd_bus_message_enter_container", enter) &&
           library.find("sd_bus_message_exit_container", exit) && library.find("sd_bus_message_skip", skip);
  }
};

/// Null where the library, or a function of it, is missing.
const BusLibrary* busLibrary() {
  static const std::unique_ptr<BusLibrary> loaded = [] {
    static const DynamicLibrary library({"libsystemd.so.0", "libelogind.so.0"});
    auto functions = std::make_unique<BusLibrary>();
    if (!library.loaded() || !functions->load(library)) functions.reset();
    return functions;
  }();
  return loaded.get();
}

/// A connection to the session's bus, and the functions for it. The destructor closes the connection; then
/// the portal closes the dialog, too.
struct Connection {
  const BusLibrary& library;
  Bus bus = nullptr;

  explicit Connection(const BusLibrary& functions) : library(functions) {
    if (library.openUser(&bus) < 0) bus = nullptr;
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() {
    if (bus) library.flushCloseUnref(bus);
  }
};

/// A message, let go when it goes.
struct Held {
  const BusLibrary& library;
  BusMessage message = nullptr;

  explicit Held(const BusLibrary& functions) : library(functions) {}
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
  ~Held() {
    if (message) library.unref(message);
  }
};

/// Why a call failed; empty where nobody was there to answer it.
std::string reasonOf(const BusLibrary& library, int result, BusError& error) {
  std::string reason = systemReason(-result);
  if (error.name != nullptr) {
    const std::string_view name = error.name;
    const bool nobody = name == "org.freedesktop.DBus.Error.ServiceUnknown" ||
                        name == "org.freedesktop.DBus.Error.NameHasNoOwner" ||
                        name == "org.freedesktop.DBus.Error.UnknownMethod" ||
                        name == "org.freedesktop.DBus.Error.UnknownInterface";
    reason = nobody ? "" : error.message != nullptr ? error.message : error.name;
  }
  library.freeError(&error);
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
void appendFilters(const BusLibrary& library, BusMessage message, const std::vector<FileFilter>& filters) {
  library.open(message, 'e', "sv");
  library.append(message, "s", "filters");
  library.open(message, 'v', "a(sa(us))");
  library.open(message, 'a', "(sa(us))");
  for (const FileFilter& filter : filters) {
    library.open(message, 'r', "sa(us)");
    library.append(message, "s", filter.name.c_str());
    library.open(message, 'a', "(us)");
    for (const std::string& extension : filter.extensions)
      library.append(message, "(us)", uint32_t(0), patternOf(extension).c_str());
    library.close(message);
    library.close(message);
  }
  library.close(message);
  library.close(message);
  library.close(message);
}

/// The option "current_folder": bytes that end with a 0.
void appendFolder(const BusLibrary& library, BusMessage message, const std::string& folder) {
  library.open(message, 'e', "sv");
  library.append(message, "s", "current_folder");
  library.open(message, 'v', "ay");
  library.appendArray(message, 'y', folder.c_str(), folder.size() + 1);
  library.close(message);
  library.close(message);
}

/// Asks for the dialog. Returns the path of the request, or an empty one and why.
std::string request(const Connection& to, const FileQuestion& question, const std::string& window,
                    std::string& why) {
  const BusLibrary& library = to.library;
  BusError error;
  Held call(library);
  Held reply(library);
  int result = library.newCall(to.bus, &call.message, kPortal, kPortalPath, kChooser,
                               question.save ? "SaveFile" : "OpenFile");
  if (result >= 0) {
    library.append(call.message, "ss", window.c_str(), question.title.c_str());
    library.open(call.message, 'a', "{sv}");
    appendFilters(library, call.message, question.filters);
    appendFolder(library, call.message, question.folder.string());
    if (question.save) library.append(call.message, "{sv}", "current_name", "s", question.name.c_str());
    // An append that failed before fails here.
    result = library.close(call.message);
  }
  if (result >= 0) result = library.call(to.bus, call.message, kPatience, &error, &reply.message);
  const char* path = "";
  if (result >= 0) result = library.read(reply.message, "o", &path);
  if (result < 0) why = reasonOf(library, result, error);
  return result < 0 ? "" : path;
}

/// The first of the URIs in a response.
std::string readUri(const BusLibrary& library, BusMessage response) {
  const char* uri = "";
  if (library.enter(response, 'a', "{sv}") < 0) return "";
  while (library.enter(response, 'e', "sv") > 0) {
    const char* key = "";
    if (library.read(response, "s", &key) < 0) return "";
    if (std::string_view(key) == "uris") {
      if (library.enter(response, 'v', "as") < 0 || library.enter(response, 'a', "s") < 0 ||
          library.read(response, "s", &uri) < 0)
        return "";
      return uri;
    }
    if (library.skip(response, "v") < 0 || library.exit(response) < 0) return "";
  }
  return "";
}

PortalAnswer readResponse(const BusLibrary& library, BusMessage response) {
  uint32_t code = 0;
  if (library.read(response, "u", &code) < 0)
    return {.there = false, .why = "it answers with nonsense", .uri = {}};
  if (code > kCancelled) return {.there = false, .why = "its dialog has ended", .uri = {}};
  return {.there = true, .why = {}, .uri = code == 0 ? readUri(library, response) : ""};
}

constexpr double kPatienceSeconds = 1.5;  // before the user is told what is waited for

}  // namespace

PortalAnswer askPortal(const FileQuestion& question, const std::string& window, const BackgroundJob& job) {
  const BusLibrary* library = busLibrary();
  if (!library) return {};
  const Connection to(*library);
  if (!to.bus) return {};
  library->setTimeout(to.bus, kPatience);
  BusError error;
  const int result =
      library->callMethod(to.bus, "org.freedesktop.DBus", "/org/freedesktop/DBus", "org.freedesktop.DBus",
                          "AddMatch", &error, nullptr, "s", kResponses);
  if (result < 0) return {.there = false, .why = reasonOf(*library, result, error), .uri = {}};
  std::string why;
  const std::string path = request(to, question, window, why);
  if (path.empty()) return {.there = false, .why = why, .uri = {}};
  while (!job.cancelled()) {
    Held message(*library);
    const int processed = library->process(to.bus, &message.message);
    if (processed < 0) return {.there = false, .why = "the bus has ended", .uri = {}};
    if (processed == 0) library->wait(to.bus, kLook);
    if (!message.message || library->isSignal(message.message, kRequest, "Response") <= 0) continue;
    if (library->pathOf(message.message) == path) return readResponse(*library, message.message);
  }
  library->callMethod(to.bus, kPortal, path.c_str(), kRequest, "Close", &error, nullptr, "");
  library->freeError(&error);
  return {.there = true, .why = {}, .uri = {}};
}

void FileDialog::ask(FileQuestion question, const std::string& window, double now) {
  question_ = std::move(question);
  asked_ = now;
  desktop_.start("portal", [question = question_, window](const BackgroundJob& job) {
    return askPortal(question, window, job);
  });
}

FileDialog::Answer FileDialog::take(double now) {
  Answer answer;
  if (desktop_.busy() && now > asked_ + kPatienceSeconds) {
    asked_ = std::numeric_limits<double>::infinity();
    answer.message = "waiting for the desktop's dialog; press the key again for another one";
  }
  const std::optional<PortalAnswer> portal = desktop_.take();
  if (!portal) return answer;
  if (!portal->there) {
    answer.message =
        "the desktop shows no dialog for files" + (portal->why.empty() ? "" : ": " + portal->why);
    answer.message += question_.save
                          ? "; the file gets a free name"
                          : "; drop a file here, start with its name, or install xdg-desktop-portal-gtk";
    if (question_.save) answer.file = question_.folder / question_.name;
  } else if (!portal->uri.empty()) {
    const std::optional<std::filesystem::path> file = fileOfUri(portal->uri);
    if (!file) answer.message = portal->uri + " is not a file of this computer";
    answer.file = file.value_or(std::filesystem::path());
  }
  return answer;
}

}  // namespace fragtrace
