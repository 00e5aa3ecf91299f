// SPDX-License-Identifier: MIT
#include "session/picture/checkpoints.h"

#include <algorithm>
#include <cinttypes>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string_view>

#include "base/errors.h"
#include "base/text.h"
#include "base/words.h"
#include "image/files/whole_file.h"
#include "image/format.h"
#include "render/adaptive.h"
#include "session/outputs.h"
#include "session/picture/draw_samples.h"
#include "session/picture/joined_parts.h"
#include "session/say.h"

namespace fragtrace {

// The totals of a film by their names.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FilmTotals, samples, rays, hitPixels, emptyPixels, nonfinitePixels,
                                   budgetHits, cut, lightPaths, pixelsPerPath, m2, lightPathM2, fewestSamples,
                                   mostSamples)

namespace {

uint64_t hashOfText(std::string_view text) {
  return hashOf(std::span(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
}

bool isFile(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

/// Returns true if the output is a whole picture. An .exr says if its render was interrupted, and how many
/// samples of which seed it has; throws UsageError when these are others. Pictures of other formats only have
/// to be readable.
bool isWholePicture(const RenderOptions& options) {
  Image picture;
  try {
    picture = readStoredImage(options.output.file, options.limits.memoryBytes);
  } catch (const InputError&) {
    say(options, options.output.file.string() + " is no whole picture: it is drawn anew");
    return false;
  }
  if (picture.attributes.contains(kInterruptedAttribute)) return false;
  if (!picture.attributes.contains(kSettingsAttribute)) return true;
  const Provenance made = provenanceOf(picture, options.output.file);
  const auto check = [&](const char* option, int64_t there, int64_t asked, const std::string& more = "") {
    if (there != asked)
      throw UsageError("--resume: " + options.output.file.string() + " is finished with " + option + " " +
                       std::to_string(there) + ", not " + std::to_string(asked) + more);
  };
  check("--seed", made.seed, options.sampling.seed);
  const int64_t missing = options.sampling.spp - made.samples;
  if (made.uniform)
    check("--spp", made.samples, options.sampling.spp,
          missing <= 0
              ? ""
              : "; `render --sample-offset " + std::to_string(made.sampleOffset + made.samples) + " --spp " +
                    std::to_string(missing) + "` to another file draws what is missing, and `merge` adds it");
  return true;
}

/// Throws InputError unless films, looks and blocks have the sizes of the part in progress.
void checkShape(const Checkpoint& c, const PictureJob& job, const DrawingPlan& plan) {
  const auto check = [&](bool right) {
    if (!right)
      throw InputError(checkpointOf(job.options.output.file).string() + ": does not fit its own settings");
  };
  check(c.part >= 0 && size_t(c.part) < plan.parts.size());
  const glm::ivec2 size = plan.parts[size_t(c.part)].size;
  const bool adaptive = isAdaptive(job.options);
  check(c.films.size() == (adaptive ? 2u : 1u) && c.looks.size() <= 2u);
  for (const FilmState& film : c.films) {
    check(film.size == size);
    check(film.splats.empty() == (film.lightPaths.count == 0));
  }
  for (const FilmPixels& look : c.looks) check(look.size == size);
  check(c.adaptive.samples.size() == (adaptive ? AdaptiveRun::blocksOf(size) : 0u));
  for (const std::vector<int32_t>& counts : {c.adaptive.samples, c.adaptive.targets})
    check(std::ranges::all_of(counts, [&](int32_t n) { return n >= 0 && n <= job.options.sampling.spp; }));
  const bool first = c.part == 0;
  check(first == c.picture.values.empty());
  check(first || glm::ivec2(c.picture.width, c.picture.height) == job.loaded.region.size);
}

/// Returns true if the render asked for differs from the checkpoint's only by more samples.
bool hasMoreSamples(const Checkpoint& checkpoint, const std::string& asked) {
  auto there = nlohmann::json::parse(checkpoint.job, nullptr, false);
  auto wanted = nlohmann::json::parse(asked, nullptr, false);
  if (!there.is_object() || !wanted.is_object() || !there["spp"].is_number_integer()) return false;
  const bool more = wanted["spp"].get<int>() > there["spp"].get<int>();
  const bool adaptive = wanted["noise"] != 0.0 || wanted["time"] != 0.0;
  there["spp"] = wanted["spp"];
  return more && !adaptive && there == wanted;
}

/// Returns why such a checkpoint cannot continue to more samples; nothing where it can.
std::string whyNotMore(const Checkpoint& checkpoint) {
  if (checkpoint.part > 0) return "parts of the picture are finished";
  return checkpoint.looks.empty() ? "" : "what --denoise reads was kept at a quarter of the samples";
}

}  // namespace

std::string measuredText(const Statistics& before, const RenderTimes& now) {
  nlohmann::json json = {{"film", before.film}, {"render_ms", now.renderMs}, {"draw_ms", now.drawMs}};
  if (before.adaptive) {
    const AdaptiveStatistics& a = *before.adaptive;
    json["adaptive"] = {a.noise, a.seconds, a.error, a.share, a.rounds, a.known, a.black};
  }
  return json.dump();
}

void restoreMeasured(const std::string& text, Statistics& stats) {
  try {
    const auto json = nlohmann::json::parse(text);
    stats.film = json.at("film");
    stats.times.renderMs = json.at("render_ms");
    stats.times.drawMs = json.at("draw_ms");
    if (json.contains("adaptive")) {
      const nlohmann::json& a = json["adaptive"];
      stats.adaptive = {{a.at(2), a.at(3), a.at(4), a.at(5), a.at(6)}, a.at(0), a.at(1)};
    }
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(std::string("its statistics are broken: ") + error.what());
  }
}

std::string jobText(const PictureJob& job, const DrawingPlan& plan) {
  const RenderOptions& options = job.options;
  auto json = nlohmann::json::parse(settingsText(options, job.loaded, job.tracer));
  json["shader (--traversal, --schedule, --dispatch, --buffer-reads)"] =
      formatted("%016" PRIx64, hashOfText(variantName(job.tracer.variant) + job.tracer.variant.literals));
  json["shader_folder"] = options.device.shaderFolder.string();
  json["seed"] = options.sampling.seed;
  json["sample_offset"] = options.sampling.sampleOffset;
  json["spp"] = options.sampling.spp;
  json["noise"] = options.sampling.noise;
  json["time"] = options.sampling.seconds;
  json["--denoise or --aov denoising"] = looksOnTheWay(options);
  for (const Region& part : plan.parts)
    json["parts"].push_back({part.corner.x, part.corner.y, part.size.x, part.size.y});
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::optional<Checkpoint> readCheckpoint(const PictureJob& job, const DrawingPlan& plan) {
  if (!job.options.output.resume) return std::nullopt;
  const std::filesystem::path path = checkpointOf(job.options.output.file);
  if (!isFile(path)) {
    say(job.options, "there is no " + path.string() + ": the picture begins anew");
    return std::nullopt;
  }
  std::optional<Checkpoint> checkpoint;
  try {
    checkpoint = decodeCheckpoint(readBytes(path, job.options.limits.memoryBytes));
  } catch (const std::exception& error) {
    throw InputError(path.string() + ": " + error.what());
  }
  const std::string text = jobText(job, plan);
  const bool grows = checkpoint->job != text && hasMoreSamples(*checkpoint, text);
  if (const std::string why = whyNotMore(*checkpoint); grows && !why.empty())
    throw UsageError("--resume: " + path.string() + " cannot continue to more samples (" +
                     differenceOf(checkpoint->job, text) + "): " + why);
  if (checkpoint->job != text && !grows)
    throw UsageError(
        "--resume: " + path.string() +
        " is of another render (its settings and those asked for): " + differenceOf(checkpoint->job, text));
  checkShape(*checkpoint, job, plan);
  return checkpoint;
}

bool isFinished(const RenderOptions& options) {
  const std::filesystem::path checkpoint = checkpointOf(options.output.file);
  if (isFile(checkpoint)) {
    if (!options.output.resume)
      say(options, "warning: " + checkpoint.string() + " is not used without --resume" +
                       (options.output.checkpointSeconds > 0.0 ? ", and will be replaced" : ""));
    return false;
  }
  const bool there = isFile(options.output.file) && isFile(options.scene);
  if (!options.output.resume || !there || !isWholePicture(options)) return false;
  // isWholePicture() has compared the samples of an .exr.
  const bool told = formatOfName(options.output.file) == ImageFormat::OpenExr;
  say(options, options.output.file.string() + " is finished: there is no checkpoint beside it" +
                   (told ? "" : "; it does not say with how many samples, and nothing is drawn"));
  return true;
}

CheckpointKeeper::CheckpointKeeper(const RenderOptions& options)
    : options_(options),
      path_(checkpointOf(options.output.file)),
      period_(options.output.checkpointSeconds),
      kept_(keepsCheckpoint(options)),
      last_(steadyMilliseconds()) {}

bool CheckpointKeeper::isDue() {
  const double now = steadyMilliseconds();
  if (period_ <= 0.0 || now - last_ < 1000.0 * period_) return false;
  last_ = now;
  return true;
}

void CheckpointKeeper::write(const Checkpoint& checkpoint) {
  try {
    replaceFile(path_, encodeCheckpoint(checkpoint));
  } catch (const RenderError& error) {
    if (!failed_) say(options_, std::string("warning: ") + error.what() + "; the render continues");
    failed_ = true;
  }
}

void CheckpointKeeper::remove() const {
  if (!kept_) return;
  removeParts(path_, PartsOf::All);  // of renders that were killed while they wrote one
  std::error_code error;
  std::filesystem::remove(path_, error);
  if (error) throw RenderError("cannot remove " + path_.string() + ": " + error.message());
}

}  // namespace fragtrace
