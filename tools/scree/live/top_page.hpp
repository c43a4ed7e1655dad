#pragma once

#include <cstdint>
#include <optional>
#include <scree/health_t.hpp>
#include <string>
#include <vector>

#include "scree/core/obstacle.hpp"

namespace scree::cli {

/// What `scree top` knows when it draws. Ages are seconds since the arrival.
struct TopView {
  std::string url;
  double waited = 0;  ///< seconds since the program's start
  std::optional<health_t> health;
  double health_age = 0;
  std::optional<ObstacleList> list;
  double list_age = 0;
  std::uint64_t refused = 0;  ///< messages that are malformed, or of another version of Scree
};

enum class Tone : std::uint8_t { plain, heading, good, warning, bad };

/// Text on a terminal; rows and columns count from 0.
struct Piece {
  int row, column;
  std::string text;
  Tone tone = Tone::plain;
};
using Page = std::vector<Piece>;

/// Lays out all of it for a terminal of that size, the most important first: a small one shows
/// less. No piece goes beyond the edges or onto another one.
Page top_page(const TopView& view, int rows, int columns);

/// An obstacle as seen from the robot: in `base`, seen from above.
struct Sighting {
  const Obstacle* obstacle;
  double ahead, left;  ///< of its centre, metres
  double distance;
};
/// Nearest first.
std::vector<Sighting> sightings(const ObstacleList& list);

/// A plot of them from above, a string a row: the robot (^) in the middle looks up, rocks are # and
/// holes O, dots lie 5 m apart. A character is twice as high as wide. `reach` metres fit ahead.
std::vector<std::string> plot(const std::vector<Sighting>& obstacles, double reach, int rows,
                              int columns);

}  // namespace scree::cli
