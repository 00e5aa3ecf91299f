// SPDX-License-Identifier: MIT
// `fragtrace sheet`: all models of a folder in one picture. Each cell is a picture of render, which stays in
// a folder next to the sheet until the sheet is whole.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/errors.h"
#include "base/folder.h"
#include "base/plugin.h"
#include "base/report.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/program.h"
#include "cli/render_command.h"
#include "gltf/edit/changed_file.h"
#include "image/files/process.h"
#include "image/files/whole_file.h"
#include "options/command_text.h"
#include "options/numbers.h"
#include "options/parse_render.h"
#include "scene/parts.h"
#include "session/interrupt.h"
#include "session/outputs.h"
#include "session/picture/denoising.h"
#include "session/picture/draw_samples.h"
#include "session/say.h"
#include "view/letters/letters.h"
#include "view/shown_text.h"

namespace fragtrace {

namespace {

namespace fs = std::filesystem;

constexpr glm::ivec2 kCellSize{320, 240};
constexpr int kMostColumns = 1000;
constexpr size_t kMostPrograms = 24;  // scenes that differ much would fill the memory with programs

constexpr int kMargin = 12;    // pixels around a cell
constexpr int kNameLines = 2;  // longer names end in dots
constexpr int kLineHeight = 16;
constexpr size_t kMostCharacters = 600;
constexpr glm::vec3 kInk{0.13f};
constexpr glm::vec3 kFailedInk{0.62f, 0.08f, 0.06f};
constexpr glm::vec3 kFailedPaper{0.93f};

/// Options of all pictures of render that a cell does not have.
constexpr std::array<std::string_view, 3> kNotOfCells{"--stats", "--aov", "--region"};

/// A cell of a sheet. What it shows is in a file, or there is a reason why it is not.
struct SheetCell {
  std::string name;
  std::filesystem::path picture;  ///< a .png
  std::string failure;            ///< the reason; empty: there is a picture
};

/// The places of cells of one size.
struct SheetLayout {
  glm::ivec2 cell{0};  ///< size of a picture
  int columns = 0;
  int rows = 0;
  int nameHeight = 0;  ///< pixels for the names of a row

  glm::ivec2 size() const;
  /// The place of a cell's picture.
  glm::ivec2 corner(int index) const;
};

/// Calls `draw` with each pixel of a rectangle that lies in the sheet, and its place in the rectangle.
template <typename Draw>
void forPixels(Image& sheet, glm::ivec2 corner, glm::ivec2 size, const Draw& draw) {
  const glm::ivec2 from = glm::max(-corner, glm::ivec2(0));
  const glm::ivec2 to = glm::min(size, glm::ivec2(sheet.width, sheet.height) - corner);
  for (int y = from.y; y < to.y; ++y) {
    for (int x = from.x; x < to.x; ++x) draw(sheet.pixel(corner.x + x, corner.y + y), x, y);
  }
}

void mix(float* pixel, const glm::vec3& color, float share) {
  for (int c = 0; c < 3; ++c) pixel[c] += share * (color[c] - pixel[c]);
}

/// Puts a picture into the middle of a cell; the page is seen where it has alpha.
void drawPicture(Image& sheet, const Image& picture, const SheetLayout& layout, int index) {
  const glm::ivec2 size(picture.width, picture.height);
  const size_t channels = picture.channelCount();
  forPixels(sheet, layout.corner(index) + (layout.cell - size) / 2, size, [&](float* pixel, int x, int y) {
    const float* from = picture.pixel(x, y);
    mix(pixel, {from[0], from[1], from[2]}, channels > 3 ? from[3] : 1.0f);
  });
}

void drawText(Image& sheet, const Letters& letters, glm::ivec2 corner, const glm::vec3& color) {
  forPixels(sheet, corner, {letters.width, letters.height}, [&](float* pixel, int x, int y) {
    mix(pixel, color, float(letters.coverage[size_t(y) * size_t(letters.width) + size_t(x)]) / 255.0f);
  });
}

/// Writes the reason into the middle of the cell.
void drawFailure(Image& sheet, const std::string& reason, const SheetLayout& layout, int index,
                 WriteLetters* write) {
  const glm::ivec2 corner = layout.corner(index);
  forPixels(sheet, corner, layout.cell, [](float* pixel, int, int) { mix(pixel, kFailedPaper, 1.0f); });
  const glm::ivec2 inside = layout.cell - 2 * kMargin;
  const Letters letters =
      write(shownText(reason, kMostCharacters), std::max(inside.x, 1), std::max(inside.y / kLineHeight, 1));
  drawText(sheet, letters, corner + (layout.cell - glm::ivec2(letters.width, letters.height)) / 2,
           kFailedInk);
}

glm::ivec2 SheetLayout::size() const {
  return glm::ivec2(columns, rows) * (cell + glm::ivec2(0, nameHeight) + kMargin) + kMargin;
}

glm::ivec2 SheetLayout::corner(int index) const {
  const glm::ivec2 place(index % columns, index / columns);
  return place * (cell + glm::ivec2(0, nameHeight) + kMargin) + kMargin;
}

/// The layout of that many cells; 0 columns: as many as rows, or one more.
SheetLayout layoutSheet(int count, glm::ivec2 cell, int columns) {
  if (columns == 0) columns = int(std::ceil(std::sqrt(double(count))));
  columns = std::clamp(columns, 1, count);
  return {cell, columns, (count + columns - 1) / columns, kNameLines * kLineHeight + kMargin / 2};
}

/// The sheet as a display shows it, on a white page. Throws InputError where a picture cannot be read.
Image drawSheet(const SheetLayout& layout, const std::vector<SheetCell>& cells, WriteLetters* write) {
  const glm::ivec2 size = layout.size();
  Image sheet{size.x, size.y, {"R", "G", "B"}, {}, {}};
  sheet.values.assign(size_t(size.x) * size_t(size.y) * 3, 1.0f);
  for (int i = 0; i < int(cells.size()); ++i) {
    const SheetCell& cell = cells[size_t(i)];
    if (cell.failure.empty())
      drawPicture(sheet, readImage(cell.picture), layout, i);
    else
      drawFailure(sheet, cell.failure, layout, i, write);
    const Letters name = write(shownText(cell.name, kMostCharacters), layout.cell.x, kNameLines);
    drawText(sheet, name, layout.corner(i) + glm::ivec2(0, layout.cell.y + kMargin / 4), kInk);
  }
  return sheet;
}

struct SheetOptions {
  RenderOptions render;  ///< the options of the cells; the output is the sheet's
  fs::path folder;
  fs::path statusFile;  ///< empty: none
  int columns = 0;      ///< 0: chosen by the number of models
};

enum class CellState : uint8_t { Waiting, Drawn, Kept, Failed };
constexpr std::array<const char*, 4> kCellStateNames{"waiting", "drawn", "kept", "failed"};

/// A model of the folder.
struct Model {
  fs::path file;
  SheetCell cell;
  CellState state = CellState::Waiting;
  RenderOptions options{};          ///< those of the sheet that the file can have
  std::vector<std::string> said{};  ///< while it was drawn
};

/// A sheet that is being drawn.
struct Sheet {
  SheetOptions options;
  fs::path folder;  ///< where the cells are
  std::vector<Model> models;
  Device device;
};

/// Appends the models of a folder and of those in it, each in natural order. Folders behind links are left
/// out, which could lead round in a circle.
void findModels(const RenderOptions& options, const fs::path& top, const fs::path& folder,
                std::vector<Model>& models) {
  const FolderContent content = readFolder(folder);
  if (!content.error.empty()) {
    if (folder == top) throw InputError(folder.string() + ": " + content.error);
    say(options, "warning: " + folder.string() + ": " + content.error);
  }
  for (const FolderEntry& entry : content.entries) {
    const fs::path path = folder / entry.name;
    const std::string extension = extensionOf(path);
    if (!entry.isFolder && (extension == ".gltf" || extension == ".glb"))
      models.push_back({path, {path.lexically_relative(top).string(), {}, {}}});
  }
  for (const FolderEntry& entry : content.entries) {
    if (entry.isFolder && !fs::is_symlink(folder / entry.name))
      findModels(options, top, folder / entry.name, models);
  }
}

/// The command that draws the cells, by which one knows those of other options.
std::string cellCommand(const SheetOptions& options) {
  RenderOptions cell = options.render;
  cell.scene = "MODEL";
  return commandText(cell) + "\n";
}

fs::path commandFileOf(const Sheet& sheet) { return sheet.folder / "command.txt"; }

/// Returns true if the picture is there and no older than the model.
bool isFresh(const Model& model) {
  std::error_code error;
  if (!fs::is_regular_file(model.cell.picture, error) || fs::file_size(model.cell.picture, error) == 0)
    return false;
  const auto drawn = fs::last_write_time(model.cell.picture, error);
  const auto made = fs::last_write_time(model.file, error);
  return !error && drawn >= made;
}

/// Keeps the cells of an earlier run of the same options where that is asked for; removes others.
void keepCells(Sheet& sheet) {
  const fs::path commandFile = commandFileOf(sheet);
  const std::string command = cellCommand(sheet.options);
  std::error_code error;
  std::vector<uint8_t> before;
  if (fs::exists(commandFile, error)) before = readWholeFile(commandFile);
  const bool isSame = std::string(before.begin(), before.end()) == command;
  const bool keeps = sheet.options.render.output.sequence.keep;
  if (keeps && !before.empty() && !isSame)
    say(sheet.options.render, "--continue: the cells in " + sheet.folder.string() +
                                  " have other options, so all models are drawn again");
  if (!before.empty() && !(keeps && isSame)) fs::remove_all(sheet.folder, error);
  for (Model& model : sheet.models) {
    if (keeps && isSame && isFresh(model)) model.state = CellState::Kept;
  }
  fs::create_directory(sheet.folder, error);
  replaceText(commandFile, command);
}

size_t countOf(const Sheet& sheet, std::initializer_list<CellState> states) {
  return size_t(std::ranges::count_if(sheet.models, [&](const Model& model) {
    return std::ranges::find(states, model.state) != states.end();
  }));
}

void writeStatus(const Sheet& sheet, bool isWritten) {
  if (sheet.options.statusFile.empty()) return;
  nlohmann::ordered_json cells = nlohmann::ordered_json::array();
  for (const Model& model : sheet.models) {
    nlohmann::ordered_json cell = {{"model", model.file.string()},
                                   {"name", model.cell.name},
                                   {"state", kCellStateNames[size_t(model.state)]}};
    if (!model.cell.failure.empty()) cell["reason"] = model.cell.failure;
    cell["said"] = model.said;
    cells.push_back(std::move(cell));
  }
  const nlohmann::ordered_json status = {{"schema", 1},
                                         {"output", sheet.options.render.output.file.string()},
                                         {"written", isWritten},
                                         {"models", sheet.models.size()},
                                         {"drawn", countOf(sheet, {CellState::Drawn, CellState::Kept})},
                                         {"failed", countOf(sheet, {CellState::Failed})},
                                         {"cells", cells}};
  replaceText(sheet.options.statusFile,
              status.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

/// The reason without the model's path before it, which the cell has as its name.
std::string reasonOf(const Model& model, const std::string& what) {
  const std::string path = model.file.string() + ": ";
  return what.starts_with(path) ? what.substr(path.size()) : what;
}

/// The line with the model's name in it, unless it names the file.
std::string withName(const Model& model, const std::string& line) {
  if (line.find(model.file.string()) != std::string::npos) return line;
  constexpr std::string_view kWarning = "warning: ";
  const bool isWarning = line.starts_with(kWarning);
  const std::string rest = isWarning ? line.substr(kWarning.size()) : line;
  return (isWarning ? std::string(kWarning) : "") + model.cell.name + ": " + rest;
}

/// A part of its file that an option names, or a value that it sets there. Not every model has it.
struct Wish {
  std::string text;
  std::function<void(const fs::path& file)> check;  ///< throws NotInFile
  std::function<void(RenderOptions&)> give;
};

using Arrays = std::vector<const char*>;

/// A wish for a part in one of these arrays of the file.
Wish partWish(const std::string& option, const std::string& name, const Arrays& arrays,
              std::function<void(RenderOptions&)> give) {
  const auto check = [=](const fs::path& file) {
    if (!hasPart(file, arrays, name)) throw NotInFile("has no " + inQuotes(name));
  };
  return {option + ": " + inQuotes(name), check, std::move(give)};
}

/// Takes the wishes out of the options.
std::vector<Wish> takeWishes(RenderOptions& options) {
  std::vector<Wish> wishes;
  SceneSelection& selection = options.selection;
  for (const SetNumber& set : std::exchange(selection.set, {}))
    wishes.push_back({"--set: " + set.pointer,
                      [=](const fs::path& file) {
                        checkChange(file, {&set, 1});
                      },
                      [=](RenderOptions& o) { o.selection.set.push_back(set); }});
  for (const std::string& name : std::exchange(selection.hiddenNodes, {}))
    wishes.push_back(partWish("--hide", name, {"/nodes"},
                              [=](RenderOptions& o) { o.selection.hiddenNodes.push_back(name); }));
  for (const std::string& name : std::exchange(selection.doubleSided, {})) {
    if (name == kAllMaterials)
      selection.doubleSided.push_back(name);
    else
      wishes.push_back(partWish("--double-sided", name, {"/materials"},
                                [=](RenderOptions& o) { o.selection.doubleSided.push_back(name); }));
  }
  if (const std::string name = std::exchange(selection.materialVariant, {}); !name.empty())
    wishes.push_back(partWish("--material-variant", name, {"/extensions/KHR_materials_variants/variants"},
                              [=](RenderOptions& o) { o.selection.materialVariant = name; }));
  if (const std::string name = std::exchange(options.camera.overrides.fitTo, {}); !name.empty())
    wishes.push_back(partWish("--fit-to", name, {"/nodes", "/materials"},
                              [=](RenderOptions& o) { o.camera.overrides.fitTo = name; }));
  return wishes;
}

/// Gives the models the options that their files can have, and says how many have each part. Throws
/// UsageError for one that none has.
void giveOptions(Sheet& sheet) {
  RenderOptions common = sheet.options.render;
  const std::vector<Wish> wishes = takeWishes(common);
  for (Model& model : sheet.models) model.options = common;
  for (const Wish& wish : wishes) {
    size_t lacking = 0;
    std::string reason;
    for (Model& model : sheet.models) {
      try {
        wish.check(model.file);
        wish.give(model.options);
      } catch (const NotInFile& error) {
        if (lacking++ == 0) reason = model.file.string() + ": " + error.what();
      } catch (const UsageError&) {
        throw;
      } catch (const std::exception&) {  // drawing it will say what is wrong with the file
        wish.give(model.options);
      }
    }
    const size_t having = sheet.models.size() - lacking;
    if (having == 0) throw UsageError(wish.text + " is in no model of the folder; " + reason);
    say(common, wish.text + " is in " + std::to_string(having) + " of " +
                    countText(sheet.models.size(), "model") +
                    (lacking > 0 ? "; the others are drawn as they are" : ""));
  }
}

/// Draws one model, and puts its name before what is said about it. An error that all models have in common
/// is thrown.
void drawCell(Sheet& sheet, Model& model, size_t index) {
  RenderOptions options = model.options;
  options.scene = model.file;
  options.output.file = model.cell.picture;
  setReportContext({{"output", sheet.options.render.output.file.string()},
                    {"model", model.file.string()},
                    {"number", index + 1},
                    {"models", sheet.models.size()}});
  if (sheet.device.programs && sheet.device.programs->count() > kMostPrograms) sheet.device.programs.reset();
  try {
    const SaidHere listening(model.said);
    std::error_code error;
    fs::create_directories(model.cell.picture.parent_path(), error);
    Statistics stats;
    const Outcome outcome = drawScene(options, {model.cell.name}, sheet.device, stats, false);
    if (outcome == Outcome::Complete) model.state = CellState::Drawn;
  } catch (const ContextLost&) {
    throw;
  } catch (const ContextError&) {
    throw;
  } catch (const std::exception& error) {
    model.state = CellState::Failed;
    model.cell.failure = reasonOf(model, error.what());
  }
  for (const std::string& line : model.said) say(options, withName(model, line));
  if (model.state == CellState::Failed) reportError(model.cell.name + ": " + model.cell.failure);
}

WriteLetters* openLetters() {
  const Plugin plugin = openPlugin(kLettersLibrary, kLettersEntry);
  if (plugin.entry != nullptr) return reinterpret_cast<WriteLetters*>(plugin.entry);
  throw RenderError(std::string("no names can be written: ") + kLettersLibrary + " cannot be opened (" +
                    plugin.error + "); the package fragtrace holds it, and scripts/build makes it");
}

/// Says what there is, and returns the status. The cells go once the sheet has them all.
int endSheet(const Sheet& sheet, bool isWritten) {
  const RenderOptions& options = sheet.options.render;
  const size_t failed = countOf(sheet, {CellState::Failed});
  const size_t drawn = countOf(sheet, {CellState::Drawn, CellState::Kept});
  const std::string all = countText(sheet.models.size(), "model");
  writeStatus(sheet, isWritten);
  if (!isWritten) {
    say(options, "interrupted: models drawn: " + std::to_string(drawn) + " of " +
                     std::to_string(sheet.models.size()) + "; they stay in " + sheet.folder.string() +
                     ", and --continue draws the others");
    return kInterruptedStatus;
  }
  std::error_code error;
  if (failed == 0) fs::remove_all(sheet.folder, error);
  say(options, options.output.file.string() + ": " + all +
                   (failed == 0 ? "" : ", of which " + std::to_string(failed) + " could not be drawn"));
  return failed > 0 ? 1 : 0;
}

int drawAll(Sheet& sheet) {
  const SheetOptions& asked = sheet.options;
  RenderOptions settled = asked.render;
  WriteLetters* const write = openLetters();
  const SheetLayout layout = layoutSheet(int(sheet.models.size()), *settled.camera.resolution, asked.columns);
  checkImageWritable(settled.output.file, layout.size().x, layout.size().y, 3, settled.output.encoding);
  sheet.device.oidn = openDenoiser(settled);
  countInterrupts();
  startImageProcess();
  keepCells(sheet);
  if (const size_t kept = countOf(sheet, {CellState::Kept}); kept > 0)
    say(settled,
        "models drawn already: " + std::to_string(kept) + " of " + std::to_string(sheet.models.size()));
  for (size_t i = 0; i < sheet.models.size() && interrupts() == 0; ++i) {
    writeStatus(sheet, false);
    if (sheet.models[i].state == CellState::Waiting) drawCell(sheet, sheet.models[i], i);
  }
  if (countOf(sheet, {CellState::Waiting}) > 0) return endSheet(sheet, false);
  std::vector<SheetCell> cells;
  for (const Model& model : sheet.models) cells.push_back(model.cell);
  writeImage(settled.output.file, drawSheet(layout, cells, write), settled.output.encoding);
  return endSheet(sheet, true);
}

void checkSheet(const SheetOptions& options) {
  const OutputOptions& out = options.render.output;
  if (out.toStandardOutput || !isDisplayFormat(out.file))
    throw UsageError("--output: a sheet has names, and is a .png or .jpg: '" + out.file.string() +
                     "' is none");
  checkEncoding(out.encoding, out.file);
  if (options.render.selection.materialVariant == kAllVariants)
    throw UsageError("--material-variant all: a cell shows one variant");
  if (!fs::is_directory(options.folder))
    throw InputError(options.folder.string() +
                     (fs::exists(options.folder) ? ": is no folder" : ": no such folder"));
  const std::array<NamedOutput, 2> outputs{{{"--output", out.file}, {"--status-file", options.statusFile}}};
  checkOutputs(outputs, inputsOf(options.render));
}

int runSheet(SheetOptions options) {
  checkSheet(options);
  OutputOptions& out = options.render.output;
  if (out.progress == ProgressForm::Json) reportAsJson(out.quiet);
  // The page of the sheet blends so.
  if (!options.render.light.background)
    say(options.render, "warning: --no-background: a sheet has no alpha, and is white behind its models");
  if (out.alpha == AlphaOf::Auto && !options.render.light.background) out.alpha = AlphaOf::Display;
  if (!options.render.camera.resolution) options.render.camera.resolution = kCellSize;
  Sheet sheet{options, fs::path(out.file) += ".cells", {}, {}};
  const fs::path top = options.folder.lexically_normal();
  findModels(options.render, top, top, sheet.models);
  if (sheet.models.empty())
    throw InputError(options.folder.string() + ": holds no .gltf or .glb; links are not followed");
  for (Model& model : sheet.models) model.cell.picture = sheet.folder / (model.cell.name + ".png");
  giveOptions(sheet);
  return leave(drawAll(sheet));
}

}  // namespace

RunCommand addSheet(CLI::App& app) {
  struct Raw {
    RawRender render;
    SheetOptions sheet;
    std::string config;
  };
  const auto raw = std::make_shared<Raw>();
  raw->render.hasQuality = true;
  app.add_option("folder", raw->sheet.folder,
                 "folder of .gltf and .glb files; those in its folders count, too")
      ->type_name("FOLDER")
      ->required();
  addOption(app, "--output", raw->render, "picture to write: .png .jpg")->required();
  app.add_option("--columns", raw->sheet.columns, "cells side by side; by default as many as rows")
      ->check(wholeNumber(1, kMostColumns))
      ->group("Output");
  for (const OptionRow& row : optionRows()) {
    const OptionGroup group = row.traits.group;
    const bool isShared =
        group == OptionGroup::Tracing || group == OptionGroup::Encoding || group == OptionGroup::Filter;
    if (isShared && std::ranges::find(kNotOfCells, row.name) == kNotOfCells.end())
      addOption(app, row.name, raw->render);
  }
  app.get_option("--resolution")->description("WIDTH,HEIGHT of a cell in pixels; 320,240 by default");
  addOption(
      app, "--continue", raw->render,
      "keep the cells that an interrupted sheet, or one with models that failed, has left in OUTPUT.cells, "
      "if they have the same options and are newer than their models");
  addOption(app, "--progress", raw->render);
  app.add_option(
         "--status-file", raw->sheet.statusFile,
         "JSON file that says of each model if it is drawn, or why not, while the sheet is drawn and at "
         "its end")
      ->type_name("FILE")
      ->group("Output");
  addConfigOption(app, raw->config);
  return [raw, &app] {
    return runConfigured(raw->render, raw->config, app, [&](const RenderOptions& options) {
      SheetOptions sheet = raw->sheet;
      sheet.render = options;
      return runSheet(sheet);
    });
  };
}

}  // namespace fragtrace
