// SPDX-License-Identifier: MIT
// What the window's controls are made of: colours, texts, rows.
#pragma once

#include <imgui.h>

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "view/shown_text.h"
#include "view/window/overlay.h"

namespace fragtrace {

/// The look of controls. Sizes at 96 dots an inch, and colours: greys without a hue, so that they do not
/// change how the picture's colours are seen, and one blue for what is on. White text on every one of them
/// has a contrast of 4.5 or more (WCAG 2.1, 1.4.3).
ImGuiStyle themeStyle();

/// The colour of the line of progress, and of the chosen side.
inline const ImVec4 kAccent{0.22f, 0.42f, 0.68f, 1.0f};

// Text and labels in Dear ImGui's frame. Whatever is not a constant of ours is drawn by this alone.

/// A window without a frame that is as large as what it says.
inline constexpr ImGuiWindowFlags kLabelFlags =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_AlwaysAutoResize |
    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

/// Draws at most `most` characters of the text (shownText), in lines up to `right`, a place in the window: 0:
/// its end; below: in one line.
inline void drawText(std::string_view text, size_t most, float right = -1.0f) {
  const std::string shown = shownText(text, most);
  ImGui::PushTextWrapPos(right);
  ImGui::TextUnformatted(shown.data(), shown.data() + shown.size());
  ImGui::PopTextWrapPos();
}

/// Typed values keep to the ends of their slider, too.
inline constexpr ImGuiSliderFlags kBounded = ImGuiSliderFlags_AlwaysClamp;
inline constexpr ImGuiSliderFlags kBoundedLogarithmic = kBounded | ImGuiSliderFlags_Logarithmic;

/// Draws a text in a dim colour at the right end of the line, or of a new line if there is no room.
void dimAtEnd(const std::string& text);

/// A label, and room for a control up to the end of the row, which has the label's place.
void label(const char* text);

/// A row of the panel with a slider.
struct Row {
  const char* name;  ///< its label, and the name of its place
  float least = 0.0f;
  float most = 1.0f;
  const char* format = "%.2f";  ///< of the value, as printf takes it
  ImGuiSliderFlags flags = kBounded;
  const char* tip = nullptr;
  std::string whyOff{};  ///< shown instead of the value; empty: the row is on
  float spare = 0.0f;    ///< pixels that are left free at its end
};

/// Draws the row of a number. Returns true when it has set the number.
bool slider(const Row& row, double& value);
bool slider(const Row& row, std::optional<double>& value);  ///< none is shown as 0
bool slider(const Row& row, int& value);

/// Draws a square of a linear colour as a display shows it (sRGB), which opens a picker with #RRGGBB. With
/// `numbers` its three linear numbers stand before it, which end `spare` pixels before the end of the row.
/// Returns true when it has set the colour, each number from 0 to `most`.
bool editColor(const char* id, glm::vec3& linear, float most = 1.0f, bool numbers = false,
               float spare = 0.0f);

/// A row with a list of names. Returns the index of the name that is chosen; none: nothing is.
std::optional<size_t> choose(const char* name, size_t count, std::optional<size_t> current,
                             const std::function<std::string(size_t)>& nameOf, ImGuiComboFlags flags = 0);

/// A sentence on the latest item, while the cursor is over it, even if that is greyed: next to the panel, or
/// else above the item, so that no other control is covered.
void tip(const std::string& text);

/// The next button on the same line, if that has room for it.
void stayOnLineFor(const char* text);

/// A part of the file in a list: "2: name".
std::string partText(size_t index, const std::string& name);

/// The key that does it.
std::string keyOf(Command command, int argument = 0);

/// A button, which has its text's place.
bool button(const char* text);
/// A small x, before what is said next.
bool closeButton(const std::string& place);
struct CommandButton {
  const char* text;
  Command command;
  int argument = 0;
};
/// Buttons for commands, in as many lines as they need.
void commandButtons(ViewFacts& facts, std::initializer_list<CommandButton> buttons);

/// A box, which has its text's place. Where it is off, the reason stands at the end of the line, else the
/// key. Returns true when it was clicked on.
bool box(const char* text, bool& on, const std::string& whyOff = {}, const std::string& key = {},
         const std::string& sentence = {});

/// Chooses from names in the order of the values.
template <typename Choice>
void choose(const char* name, std::span<const std::string_view> names, Choice& choice) {
  const auto nameOf = [&](size_t i) { return std::string(names[i]); };
  if (const auto chosen = choose(name, names.size(), size_t(choice), nameOf)) choice = Choice(*chosen);
}

/// Draws a line for each file that was shown before, grey where it is gone.
void drawRecentFiles(ViewFacts& facts);

/// Draws the panel, with every stage, switch and setting, into the frame that Dear ImGui is making; what is
/// changed there changes the state.
void drawPanel(ViewState& state, ViewFacts& facts, const WindowLayout& layout);

}  // namespace fragtrace
