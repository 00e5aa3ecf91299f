// SPDX-License-Identifier: MIT
// Messages on stderr beside the results: lines of text, or JSON for other programs, one object a line
// (docs/recipes.md, "Use fragtrace in a program").
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace fragtrace {

/// From now on all that is told is JSON; quiet: errors alone.
void reportAsJson(bool quiet);
/// From any thread or signal handler.
bool reportsAsJson();

/// "warning: ...", "note: ..." or another message. As JSON its type is that word, or "message".
void reportMessage(const std::string& text);
/// Also when quiet.
void reportError(const std::string& text);

/// Members that events have from now on, such as the picture that is drawn.
void setReportContext(const nlohmann::ordered_json& members);
/// An object of that type with `members`, the seconds since the process began, and the context. Nothing where
/// text is told, or when quiet. Of "progress" one is told in a tenth of a second. From any thread.
void reportEvent(const char* type, const nlohmann::ordered_json& members);
/// The last line where JSON is told, with the exit status, also when quiet; only the first call tells it.
void reportEnd(int status);

}  // namespace fragtrace
