#include "server/global_cloud/background.hpp"

#include <algorithm>
#include <cmath>

namespace liloc {
namespace {

// Frames in a surface that speaks for its neighbours, and for itself when something nearer hides it; by hand.
constexpr int kProven = 4;
constexpr int kCompany = 2;  // neighbours that move or are gone as well, or it is noise; by hand, DECISIONS.md

constexpr float kHoldShare = 0.003F;  // of the depth; by hand, DECISIONS.md
// Times as many in a mean make it worth showing anew; by hand, DECISIONS.md.
constexpr int kMoreFrames = 3;

constexpr std::size_t kMeasureEvery = 5;  // pixels, another fifth each frame: enough by far within a second
constexpr float kGapGain = 1.0F / 16;     // of a gap in the pixel's mean; by hand
constexpr float kLeastLost = 0.002F;      // nothing is surer than that; by hand
constexpr double kMostMissing = 0.95;     // a pixel with fewer returns is forgotten as if it had these; by hand
constexpr std::uint16_t kMostMissed = 60'000;  // frames; it fits 16 bits

bool lasted(std::uint32_t since_ms, std::uint32_t now_ms, double seconds) {
  return static_cast<double>(now_ms - since_ms) >= 1e3 * seconds;
}

}  // namespace

Background::Background(const Camera& camera, const BackgroundOptions& options, const DepthNoise& known)
    : options_(options),
      width_(camera.width),
      height_(camera.height),
      scale_m_(camera.depth_scale_m),
      pixels_(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height)),
      kinds_(pixels_.size(), Kind::nothing),
      meter_(known) {}

float Background::tolerance_of(float units) const {
  const double z_m = units * scale_m_;
  return static_cast<float>(
      std::max(options_.tolerance_m + 0.01 * z_m, options_.tolerance_sigmas * noise().sigma_m(z_m)) / scale_m_);
}

void Background::replace(Pixel* pixel, float units) {
  pixel->surface = units;
  pixel->averaged = 1;
  pixel->doubted = false;
  pixel->candidates = 0;
  pixel->missed = 0;
  pixel->gap = static_cast<float>(1 / (1 - std::min(noise().missing, kMostMissing)));
  ++replaced_;
}

template <class Visit>
void Background::for_each_around(std::size_t i, const Visit& visit) const {
  const int u = static_cast<int>(i) % width_, v = static_cast<int>(i) / width_;
  for (int y = std::max(0, v - 1); y <= std::min(height_ - 1, v + 1); ++y)
    for (int x = std::max(0, u - 1); x <= std::min(width_ - 1, u + 1); ++x)
      if (x != u || y != v)
        visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x));
}

bool Background::continues_a_neighbour(std::size_t i, float units) const {
  bool continues = false;
  for_each_around(i, [&](std::size_t j) {
    const Pixel& p = pixels_[j];
    continues |= p.surface > 0 && p.averaged >= kProven && !p.missing &&
                 std::abs(p.surface - units) <= tolerance_of(units);
  });
  return continues;
}

Background::Kind Background::learn(std::size_t i, float units, std::uint32_t now_ms) {
  Pixel* pixel = &pixels_[i];
  const float nearer = pixel->surface - units;
  pixel->missing = false;
  pixel->gap += kGapGain * (static_cast<float>(pixel->missed + 1) - pixel->gap);
  pixel->missed = 0;
  if (pixel->surface > 0 && std::abs(nearer) <= tolerance_of(units)) {
    if (pixel->averaged < options_.most_averaged) ++pixel->averaged;
    pixel->surface -= nearer / static_cast<float>(pixel->averaged);
    pixel->candidates = 0;
    return Kind::still;
  }
  if (pixel->candidates == 0 || std::abs(pixel->candidate - units) > tolerance_of(units)) {
    pixel->candidate = units;
    pixel->candidate_since_ms = now_ms;
    pixel->candidates = 0;
  }
  if (pixel->candidates < 255) ++pixel->candidates;
  const bool farther = pixel->surface > 0 && nearer < 0, gone = farther && pixel->candidates >= 2;
  const bool absorbed = lasted(pixel->candidate_since_ms, now_ms, options_.absorb_seconds);
  const bool more = pixel->surface == 0 && continues_a_neighbour(i, units);
  if (!gone && !absorbed && !more) return farther ? Kind::farther : Kind::nearer;
  replace(pixel, units);
  return Kind::still;
}

void Background::miss(Pixel* pixel, std::uint32_t now_ms) {
  if (pixel->surface == 0) return;
  if (!pixel->missing) pixel->missing_since_ms = now_ms;
  pixel->missing = true;
  if (pixel->missed < kMostMissed) ++pixel->missed;
  if (lasted(pixel->missing_since_ms, now_ms, options_.forget_seconds) &&
      surprisal_of_missing(*pixel) >= static_cast<float>(options_.forget_surprisal))
    replace(pixel, 0);
}

/// Had each frame its own chance of a return.
float Background::surprisal_of_missing(const Pixel& pixel) const {
  const float lost = std::clamp(1 - 1 / pixel.gap, kLeastLost, static_cast<float>(kMostMissing));
  return -static_cast<float>(pixel.missed) * std::log(lost);
}

void Background::measure() {
  int known = 0, missing = 0, returns = 0, flying = 0;
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    known += pixels_[i].surface > 0;
    missing += pixels_[i].surface > 0 && pixels_[i].missing;
    returns += kinds_[i] != Kind::nothing;
    flying += kinds_[i] == Kind::farther;
  }
  meter_.add_frame(known, missing, returns, flying);
}

Layers Background::learn(const DepthImage& image) {
  const bool first = frames_ == 0;
  last_ns_ = image.stamp_ns;
  ++frames_;
  const auto now_ms = static_cast<std::uint32_t>(image.stamp_ns / 1'000'000);
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    kinds_[i] = Kind::nothing;
    if (image.units[i] == 0) {
      miss(&pixels_[i], now_ms);
      continue;
    }
    if (first) replace(&pixels_[i], image.units[i]);
    if (pixels_[i].last > 0 && (i + static_cast<std::size_t>(frames_)) % kMeasureEvery == 0)
      meter_.add_pair(image.units[i] * scale_m_, (image.units[i] - pixels_[i].last) * scale_m_);
    pixels_[i].last = image.units[i];
    kinds_[i] = learn(i, image.units[i], now_ms);
    doubt(&pixels_[i], kinds_[i]);
  }
  measure();
  return separated(image);
}

template <class Alike>
bool Background::in_company(std::size_t i, const Alike& alike) const {
  int count = 0;
  for_each_around(i, [&](std::size_t j) { count += alike(j) ? 1 : 0; });
  return count >= kCompany;
}

bool Background::gone(std::size_t i, float units) const {
  const Pixel& pixel = pixels_[i];
  if (pixel.shown == 0) return false;
  const float farther = units - pixel.shown;
  if (units > 0) return farther > 0.01F * units && farther > tolerance_of(units);  // 1 % of it at least
  return pixel.surface == 0 || surprisal_of_missing(pixel) >= static_cast<float>(options_.forget_surprisal);
}

Layers Background::separated(const DepthImage& image) const {
  const DepthImage none{image.stamp_ns, width_, height_, std::vector<std::uint16_t>(pixels_.size(), 0)};
  Layers layers{image, none, none};
  const auto is_gone = [&](std::size_t j) { return gone(j, image.units[j]); };
  const auto is_nearer = [&](std::size_t j) { return kinds_[j] == Kind::nearer; };
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    if (is_gone(i) && in_company(i, is_gone)) layers.gone.units[i] = pixels_[i].shown;
    if (kinds_[i] == Kind::nothing || kinds_[i] == Kind::still) continue;
    layers.still.units[i] = 0;
    if (kinds_[i] == Kind::farther || !in_company(i, is_nearer)) continue;
    layers.moving.units[i] = image.units[i];
    for_each_around(i, [&](std::size_t j) { layers.still.units[j] = 0; });
  }
  if (std::ranges::none_of(layers.gone.units, [](std::uint16_t units) { return units > 0; })) layers.gone = {};
  return layers;
}

bool Background::gained() const {
  return frames_ == 3 || frames_ == 10 || frames_ == 30;
}

Change Background::change() const {
  const double share = static_cast<double>(replaced_) / static_cast<double>(pixels_.size());
  if (gained() || share > options_.fresh_share) return Change::large;
  return share > options_.small_share ? Change::small : Change::none;
}

void Background::doubt(Pixel* pixel, Kind kind) {
  if (pixel->averaged >= kProven)
    pixel->doubted = false;
  else if (kind == Kind::nearer && !pixel->doubted) {
    pixel->doubted = true;
    replaced_ += pixel->shown != 0 ? 1 : 0;
  }
}

void Background::show(Pixel* pixel) const {
  if (pixel->doubted) {
    pixel->shown = 0;
    return;
  }
  const auto units = static_cast<std::uint16_t>(std::lround(pixel->surface));
  const float hold = static_cast<float>(options_.hold_m / scale_m_) + kHoldShare * pixel->surface;
  const bool appeared = (units == 0) != (pixel->shown == 0),
             moved = std::abs(pixel->surface - pixel->shown) > hold;
  if (!appeared && !moved && !gained() && pixel->averaged < kMoreFrames * pixel->shown_averaged) return;
  pixel->shown = units;
  pixel->shown_averaged = pixel->averaged;
}

DepthImage Background::surfaces() {
  replaced_ = 0;
  DepthImage image{last_ns_, width_, height_, {}};
  image.units.reserve(pixels_.size());
  for (Pixel& pixel : pixels_) {
    show(&pixel);
    image.units.push_back(pixel.shown);
  }
  return image;
}

}  // namespace liloc
