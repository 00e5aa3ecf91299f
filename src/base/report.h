// SPDX-License-Identifier: MIT
// Messages on stderr next to the results: lines of text, or JSON for other programs, one object per line
// (docs/recipes.md, "Use fragtrace in a program").
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace fragtrace {

/// From now on all messages are JSON. If `quiet`, only errors are reported.
void reportAsJson(bool quiet);
/// Returns true after reportAsJson(). Any thread or signal handler may call it.
bool reportsAsJson();

/// "warning: ...", "note: ..." or another message. As JSON its type is that word, or "message".
void reportMessage(const std::string& text);
/// Reports an error, also if quiet.
void reportError(const std::string& text);

/// Members that events have from now on, such as the picture that is drawn.
void setReportContext(const nlohmann::ordered_json& members);
/// Reports an object of that type with `members`, the seconds since the process began, and the context. Does
/// nothing if messages are text, or if quiet. Of type "progress" it reports at most one in a tenth of a
/// second. Any thread may call it.
void reportEvent(const char* type, const nlohmann::ordered_json& members);
/// Reports the last line if messages are JSON, with the exit status, also if quiet. Only the first call does
/// so.
void reportEnd(int status);

}  // namespace fragtrace
