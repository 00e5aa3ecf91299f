// SPDX-License-Identifier: MIT
// Makes rows of the option table, by the type of the option's value.
#pragma once

#include <CLI/CLI.hpp>
#include <concepts>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "options/numbers.h"
#include "options/option_row.h"
#include "options/option_text.h"
#include "options/parse_render.h"

/// The member at that place of RenderOptions, for the makers below.
#define FRAGTRACE_MEMBER(path) ([](auto& options) -> auto& { return options.path; })

namespace fragtrace {

template <typename Number>
struct NumberRange {
  Number least;
  Number most;
};

/// Exact, as the command line reads it.
template <typename Number>
std::string numberText(Number value) {
  if constexpr (std::floating_point<Number>)
    return exactText(value);
  else
    return std::to_string(value);
}

/// "a,b,c"
template <typename... Numbers>
std::string numbersText(Numbers... values) {
  std::string text;
  ((text += (text.empty() ? "" : ",") + numberText(values)), ...);
  return text;
}

/// A row whose members are one member. Its maker adds the declaration and, unless it is a flag, the words.
template <typename Member>
OptionRow memberRow(const char* name, std::string help, Member member, OptionTraits traits) {
  OptionRow row{.name = name, .help = std::move(help), .traits = traits};
  row.isDefault = [member](const RenderOptions& o) {
    static const RenderOptions standard;
    return member(o) == member(standard);
  };
  row.words = [](const RenderOptions&) { return std::vector<std::string>(); };
  row.copy = [member](RenderOptions& to, const RenderOptions& from) { member(to) = member(from); };
  return row;
}

template <typename Member>
OptionRow flag(const char* name, std::string help, Member member, OptionTraits traits) {
  OptionRow row = memberRow(name, std::move(help), member, traits);
  row.add = [member](CLI::App& app, const OptionRow& r, RawRender& raw) {
    app.add_flag(r.name, member(raw.options), r.help);
  };
  row.value = [member](const RenderOptions& o) { return AttributeValue(bool(member(o))); };
  return row;
}

/// A flag that turns off what is on by default.
template <typename Member>
OptionRow offFlag(const char* name, std::string help, Member member, OptionTraits traits) {
  OptionRow row = memberRow(name, std::move(help), member, traits);
  row.add = [member](CLI::App& app, const OptionRow& r, RawRender& raw) {
    app.add_flag_callback(
        r.name, [member, &raw] { member(raw.options) = false; }, r.help);
  };
  row.value = [member](const RenderOptions& o) { return AttributeValue(bool(member(o))); };
  return row;
}

/// A number, or a std::optional one. `shown`: --help names its default, which else means none.
template <typename Number, typename Member>
OptionRow numberRow(const char* name, std::string help, Member member,
                    std::optional<NumberRange<Number>> range, bool shown, OptionTraits traits) {
  OptionRow row = memberRow(name, std::move(help), member, traits);
  row.add = [member, range, shown](CLI::App& app, const OptionRow& r, RawRender& raw) {
    CLI::Option* option = app.add_option(r.name, member(raw.options), r.help);
    if constexpr (std::floating_point<Number>) {
      option->check(range ? realNumber(range->least, range->most) : realNumber());
    } else if (range) {
      option->check(wholeNumber(range->least, range->most));
    }
    if (shown) option->capture_default_str();
    if (r.traits.excludes != nullptr) option->excludes(r.traits.excludes);
  };
  const auto valueOf = [member](const RenderOptions& o) {
    if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(member(o))>>)
      return member(o);
    else
      return *member(o);
  };
  row.words = [valueOf](const RenderOptions& o) { return std::vector{numberText(valueOf(o))}; };
  if (traits.attribute != nullptr)
    row.value = [valueOf](const RenderOptions& o) {
      if constexpr (std::floating_point<Number>)
        return AttributeValue(double(valueOf(o)));
      else
        return AttributeValue(int(valueOf(o)));
    };
  if (range) row.examples = {numberText(range->least), numberText(range->most)};
  if (std::floating_point<Number> && !range) row.examples = {"-1.5", "0.30000001192092896"};
  return row;
}

/// A number that has a default.
template <typename Number, typename Member>
OptionRow number(const char* name, std::string help, Member member, NumberRange<Number> range,
                 OptionTraits traits) {
  return numberRow<Number>(name, std::move(help), member, std::optional(range), true, traits);
}

/// A number that is absent by default.
template <typename Number, typename Member>
OptionRow limit(const char* name, std::string help, Member member, NumberRange<Number> range,
                OptionTraits traits) {
  return numberRow<Number>(name, std::move(help), member, std::optional(range), false, traits);
}

/// Declares an option whose values `take` puts into the options, as one word.
template <typename Take>
void addWord(CLI::App& app, const OptionRow& row, RawRender& raw, const Take& take,
             const char* type = "TEXT") {
  CLI::Option* option = app.add_option_function<std::string>(
      row.name, [take, &raw](const std::string& word) { take(raw.options, word); }, row.help);
  option->type_name(type);
  if (row.traits.excludes != nullptr) option->excludes(row.traits.excludes);
}

template <typename Value>
struct NamedValue {
  using Type = Value;
};
template <typename Value>
struct NamedValue<std::optional<Value>> {
  using Type = Value;
};

/// One of some names, in the order of the values, or of none. {} in the help stands for the names; without it
/// they follow.
template <typename Names, typename Member>
OptionRow choice(const char* name, std::string help, Member member, const Names& names, OptionTraits traits) {
  const size_t place = help.find("{}");
  if (place == std::string::npos)
    help += ": " + joined(names);
  else
    help.replace(place, 2, joined(names));
  OptionRow row = memberRow(name, std::move(help), member, traits);
  row.choices.assign(names.begin(), names.end());
  row.examples = row.choices;
  row.words = [member, known = row.examples](const RenderOptions& o) {
    return std::vector{known[size_t(*std::optional(member(o)))]};
  };
  row.add = [member, known = row.examples](CLI::App& app, const OptionRow& r, RawRender& raw) {
    using Value = typename NamedValue<std::remove_cvref_t<decltype(member(raw.options))>>::Type;
    addWord(app, r, raw, [member, known, name = r.name](RenderOptions& o, const std::string& word) {
      member(o) = choose<Value>(name, word, known);
    });
    const std::optional<Value> standard = member(raw.options);
    if (standard) app.get_option(r.name)->default_str(known[size_t(*standard)]);
  };
  return row;
}

/// A word: text, or a path. --help shows `type`, which is TEXT, FILE or FOLDER.
template <typename Member>
OptionRow word(const char* name, std::string help, Member member, OptionTraits traits,
               const char* type = "TEXT") {
  OptionRow row = memberRow(name, std::move(help), member, traits);
  row.examples = {"-a b's"};
  row.add = [member, type](CLI::App& app, const OptionRow& r, RawRender& raw) {
    addWord(
        app, r, raw, [member](RenderOptions& o, const std::string& text) { member(o) = text; }, type);
  };
  row.words = [member](const RenderOptions& o) {
    return std::vector{std::filesystem::path(member(o)).string()};
  };
  row.value = [member](const RenderOptions& o) {
    return AttributeValue(std::filesystem::path(member(o)).filename().string());
  };
  return row;
}

/// A colour in one word, as colorIn() reads it.
template <typename Member>
OptionRow color(const char* name, std::string help, Member member, double most, OptionTraits traits) {
  OptionRow row =
      memberRow(name, std::move(help) + "; a colour's name or #rrggbb, or linear R,G,B", member, traits);
  row.examples = {"0.8999999761581421,0.5,1", "white", "#1e90ff"};
  row.add = [=](CLI::App& app, const OptionRow& r, RawRender& raw) {
    addWord(app, r, raw, [=, option = r.name](RenderOptions& o, const std::string& text) {
      member(o) = colorIn(option, text, most);
    });
  };
  row.words = [member](const RenderOptions& o) {
    const glm::vec3& c = *member(o);
    return std::vector{numbersText(double(c.r), double(c.g), double(c.b))};
  };
  return row;
}

/// Numbers in one word, separated by commas, which `take` puts into the options; it throws UsageError. `form`
/// is how the word may be written, for messages.
template <typename Number, typename Member, typename Take, typename Write>
OptionRow numbers(const char* name, std::string help, Member member, int count, Take take, Write write,
                  std::vector<std::string> examples, OptionTraits traits,
                  std::optional<NumberRange<int>> range = std::nullopt, const char* form = "") {
  OptionRow row = memberRow(name, std::move(help), member, traits);
  row.examples = std::move(examples);
  row.add = [=](CLI::App& app, const OptionRow& r, RawRender& raw) {
    CLI::Option* option = app.add_option_function<std::vector<Number>>(
        r.name,
        [take, member, &raw](const std::vector<Number>& values) { member(raw.options) = take(values); },
        r.help);
    option->delimiter(',')->expected(count);
    if constexpr (std::floating_point<Number>)
      option->check(realNumber(form));
    else if (range)
      option->check(wholeNumber(range->least, range->most, form));
  };
  row.words = [member, write](const RenderOptions& o) { return std::vector<std::string>{write(*member(o))}; };
  return row;
}

}  // namespace fragtrace
