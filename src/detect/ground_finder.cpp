#include "scree/detect/ground_finder.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "scree/detect/neighbours.hpp"
#include "scree/detect/union_find.hpp"

namespace scree {

GroundFinder::GroundFinder(const GroundFinderSettings& settings, std::size_t max_cells)
    : settings_(settings),
      smooth_(max_cells),
      ground_(max_cells),
      patch_(max_cells),
      queue_(max_cells),
      patches_(max_cells),
      fill_(max_cells),
      trend_(has_trend() ? max_cells : 0),
      windows_(has_trend() ? 0 : max_cells),
      depressions_(has_trend() ? 0 : max_cells) {}

void GroundFinder::find(const GroundRaster& raster, float* seen, Accuracy accuracy) {
  columns_ = raster.columns;
  rows_ = raster.rows;
  cell_ = raster.cell_size;
  seen_ = seen;
  depressions_.clear();
  find_smooth_cells();
  if (!has_trend()) add_planar_cells();
  find_patches();
  if (has_trend()) {
    trend_.fit(columns_, rows_, ground_.data(), seen_, cell_, settings_.trend_reach);
    trend_.add_to(seen_, -1);  // from now on heights are above the trend
    join_trend();
    join_patches(accuracy);
    trend_.add_to(seen_, 1);
    trend_.add_to(smooth_.data(), 1);
  } else {
    join_windows();
    const Tilt tilt = main_tilt();
    add_tilt(tilt, -1, seen_);  // from now on heights are above the tilted plane
    join_patches(accuracy);
    const bool has_craters = depressions_.remove({columns_, rows_, cell_, smooth_.data()}, ground_);
    if (has_craters) span(RasterFill::kSteps);
    add_tilt(tilt, 1, seen_);
    add_tilt(tilt, 1, smooth_.data());
  }
}

/// That of the largest patch where it is much of what was seen: a cloud need not be level, and
/// ground that is not seen goes on as it does there. Else none.
GroundFinder::Tilt GroundFinder::main_tilt() const {
  constexpr float kMuch = 0.25F;  // of the cells that were seen
  constexpr double kSteep = 0.3;  // metres per metre
  const auto largest = std::ranges::max_element(patches_, {}, &Patch::cells);
  if (largest == patches_.end()) return {};
  const auto number = static_cast<std::uint32_t>(largest - patches_.begin());
  float seen = 0;
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d products = Eigen::Vector3d::Zero();
  for (std::size_t cell = 0; cell < patch_.size(); ++cell) {
    if (std::isnan(seen_[cell])) continue;
    ++seen;
    if (patch_[cell] != number) continue;
    const std::size_t row = cell / columns_, column = cell % columns_;
    const Eigen::Vector3d at(static_cast<double>(column), static_cast<double>(row), 1);
    squares += at * at.transpose();
    products += at * static_cast<double>(seen_[cell]);
  }
  if (static_cast<float>(largest->cells) < kMuch * seen) return {};
  const Eigen::Vector3d plane = squares.ldlt().solve(products);
  const double slope = plane.head<2>().norm() / static_cast<double>(cell_);
  if (!(slope <= kSteep)) return {};
  return {static_cast<float>(plane.x()), static_cast<float>(plane.y())};
}

void GroundFinder::add_tilt(const Tilt& tilt, float sign, float* heights) const {
  if (tilt.along == 0 && tilt.across == 0) return;
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t column = 0; column < columns_; ++column) {
      heights[row * columns_ + column] +=
          sign * (tilt.along * static_cast<float>(column) + tilt.across * static_cast<float>(row));
    }
  }
}

/// The largest; among trees, where all are small, the lowest of those that are nearly as large.
/// @pre there is one
GroundFinder::Patch& GroundFinder::first_patch() {
  constexpr float kSmall = 3;  // square metres
  Patch& largest = *std::ranges::max_element(patches_, {}, &Patch::cells);
  if (has_trend() || static_cast<float>(largest.cells) * cell_ * cell_ >= kSmall) return largest;
  for (Patch& patch : patches_) patch.residual = 0;
  for (std::size_t cell = 0; cell < patch_.size(); ++cell) {
    if (patch_[cell] != kNoLabel) patches_[patch_[cell]].residual += seen_[cell];
  }
  const auto height = [&](const Patch& patch) {
    return 2 * patch.cells >= largest.cells ? patch.residual / static_cast<float>(patch.cells)
                                            : std::numeric_limits<float>::infinity();
  };
  return *std::ranges::min_element(patches_, {}, height);
}

void GroundFinder::find_smooth_cells() {
  ground_.assign(columns_ * rows_, 0);
  const float limit = 2 * cell_ * settings_.max_slope;
  for (std::size_t row = 1; row + 1 < rows_; ++row) {
    for (std::size_t column = 1; column + 1 < columns_; ++column) {
      const std::size_t cell = row * columns_ + column;
      if (std::isnan(seen_[cell])) continue;
      const float rise_x = rise(cell, 1, columns_), rise_y = rise(cell, columns_, 1);
      // False where a neighbour is not known.
      ground_[cell] = rise_x * rise_x + rise_y * rise_y <= limit * limit ? 1 : 0;
    }
  }
}

/// Makes smooth what lies on the plane of a window: cells without neighbours, whose slope cannot be
/// told, and those on a wide bank.
void GroundFinder::add_planar_cells() {
  windows_.find(columns_, rows_, seen_, cell_, settings_.max_slope);
  const float limit = 2 * cell_ * settings_.max_slope;
  for_each_planar_cell([&](const PlanarWindow& window, std::size_t cell) {
    if (ground_[cell] != 0) return;
    const float rise_x = rise(cell, 1, columns_), rise_y = rise(cell, columns_, 1);
    // False where a neighbour is not known.
    const bool is_steep =
        std::hypot(rise_x - 2 * window.rise_x, rise_y - 2 * window.rise_y) > limit;
    if (!is_steep) ground_[cell] = 1;
  });
}

/// Makes one patch of those that lie on the plane of one window.
void GroundFinder::join_windows() {
  queue_.clear();  // by patch: the one that it was joined to
  for (std::uint32_t i = 0; i < patches_.size(); ++i) queue_.push_back(i);
  const PlanarWindow* last = nullptr;
  std::uint32_t root = 0;
  for_each_planar_cell([&](const PlanarWindow& window, std::size_t cell) {
    if (patch_[cell] == kNoLabel) return;
    const std::uint32_t other = root_of(queue_, patch_[cell]);
    if (&window != std::exchange(last, &window)) {
      root = other;
    } else if (other != root) {
      queue_[other] = root;
      patches_[root].cells += std::exchange(patches_[other].cells, 0);
    }
  });
  for (std::uint32_t& patch : patch_) {
    if (patch != kNoLabel) patch = root_of(queue_, patch);
  }
}

/// Calls visit(window, cell) for the cells that lie on a window's plane.
template <class Visit>
void GroundFinder::for_each_planar_cell(const Visit& visit) const {
  for (const PlanarWindow& window : windows_.all()) {
    windows_.for_each_cell(window, columns_, seen_, [&](std::size_t cell, float off) {
      if (std::abs(off) <= PlanarWindows::kThickness) visit(window, cell);
    });
  }
}

float GroundFinder::rise(std::size_t cell, std::size_t along, std::size_t across) const {
  float weight = 0, rise = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t middle = cell + k * across - across;
    const float step = seen_[middle + along] - seen_[middle - along];
    if (std::isnan(step)) continue;
    const float w = k == 1 ? 2.0F : 1.0F;
    weight += w;
    rise += w * step;
  }
  return weight > 0 ? rise / weight : kUnseen;
}

void GroundFinder::find_patches() {
  // The heights of single cells are noisier than the rise over three of them.
  const float straight = 1.5F * settings_.max_slope * cell_, diagonal = 1.4142F * straight;
  patch_.assign(columns_ * rows_, kNoLabel);
  patches_.clear();
  for (std::uint32_t seed = 0; seed < patch_.size(); ++seed) {
    if (ground_[seed] == 0 || patch_[seed] != kNoLabel) continue;
    const auto number = static_cast<std::uint32_t>(patches_.size());
    queue_.clear();
    queue_.push_back(seed);
    patch_[seed] = number;
    for (std::size_t next = 0; next < queue_.size(); ++next) {
      const auto around = neighbours(queue_[next], columns_);
      for (std::size_t i = 0; i < around.size(); ++i) {
        const std::size_t cell = around[i];
        if (ground_[cell] == 0 || patch_[cell] != kNoLabel) continue;
        const float way = i < kSides ? straight : diagonal;
        if (std::abs(seen_[cell] - seen_[queue_[next]]) > way) continue;
        patch_[cell] = number;
        queue_.push_back(static_cast<std::uint32_t>(cell));
      }
    }
    patches_.push_back({static_cast<std::uint32_t>(queue_.size())});
  }
}

/// Makes ground of the patches that lie on the trend. A lidar's rings make many small patches, and
/// the largest of them need not be ground.
void GroundFinder::join_trend() {
  constexpr float kShare = 0.5F;  // the trend is not as near to the ground as the surface will be
  for (std::size_t cell = 0; cell < patch_.size(); ++cell) {
    if (patch_[cell] != kNoLabel) patches_[patch_[cell]].residual += seen_[cell];
  }
  for (Patch& patch : patches_) {
    const float cells = static_cast<float>(patch.cells);
    patch.is_ground = std::abs(patch.residual) <= kShare * settings_.tolerance * cells;
  }
}

void GroundFinder::join_patches(Accuracy accuracy) {
  // Patches that join let others join, which is soon at an end.
  const int rounds = accuracy == Accuracy::full ? 3 : 1;
  const std::size_t cells = columns_ * rows_;
  smooth_.resize(cells);
  if (!patches_.empty()) first_patch().is_ground = true;
  mark_ground();
  for (int round = 0; round < rounds; ++round) {
    span(RasterFill::kRoughSteps);
    for (Patch& patch : patches_) patch.residual = 0;
    for (std::size_t cell = 0; cell < cells; ++cell) {
      if (patch_[cell] == kNoLabel) continue;
      patches_[patch_[cell]].residual += seen_[cell] - smooth_[cell];
    }
    bool joined = false;
    for (Patch& patch : patches_) {
      if (patch.is_ground) continue;
      patch.is_ground =
          std::abs(patch.residual) <= settings_.tolerance * static_cast<float>(patch.cells);
      joined |= patch.is_ground;
    }
    if (!joined) break;
    mark_ground();
  }
  span(accuracy == Accuracy::full ? RasterFill::kSteps : RasterFill::kRoughSteps);
}

void GroundFinder::mark_ground() {
  for (std::size_t cell = 0; cell < ground_.size(); ++cell) {
    ground_[cell] = patch_[cell] != kNoLabel && patches_[patch_[cell]].is_ground ? 1 : 0;
  }
}

float GroundFinder::blurred(std::size_t cell) const {
  float weight = 0, height = 0;
  for (std::size_t v = 0; v < 3; ++v) {
    for (std::size_t u = 0; u < 3; ++u) {
      const std::size_t other = cell + v * columns_ + u - columns_ - 1;
      const float z = seen_[other];
      if (ground_[other] == 0) continue;
      const float w = (u == 1 ? 2.0F : 1.0F) * (v == 1 ? 2.0F : 1.0F);
      weight += w;
      height += w * z;
    }
  }
  return weight > 0 ? height / weight : kUnseen;
}

/// Spans the surface from the ground.
void GroundFinder::span(int steps) {
  for (std::size_t cell = 0; cell < ground_.size(); ++cell) {
    if (ground_[cell] != 0) smooth_[cell] = blurred(cell);
  }
  fill_.fill(columns_, rows_, ground_.data(), smooth_.data(), steps);
}

}  // namespace scree
