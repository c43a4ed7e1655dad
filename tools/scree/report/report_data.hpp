#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "draw/height_raster.hpp"
#include "scoring/scoring.hpp"
#include "scree/config/settings.hpp"
#include "scree/core/obstacle.hpp"
#include "scree/core/obstacle_grid.hpp"
#include "scree/core/point_cloud.hpp"

namespace scree::cli {

/// A number along the way.
struct Series {
  std::string name, unit;
  std::vector<std::int64_t> t_ns;
  std::vector<double> values;

  void add(std::int64_t time_ns, double value) {
    t_ns.push_back(time_ns);
    values.push_back(value);
  }
};

/// Something that lasted from one time to another, as "blind".
struct ReportEvent {
  std::string kind, text;
  std::int64_t from_ns = 0, to_ns = 0;
};

/// Gathers what the page of a report shows.
class ReportData {
public:
  std::string title, source;         ///< of the page; what was reported on
  std::optional<StopSettings> stop;  ///< not told by lists alone

  void add(const ObstacleList& list);
  /// Those of the list added last, in `base`; every so many of them are kept.
  void add_sweep(const PointView& points);
  /// Kept twice a second.
  void add(const ObstacleGrid& grid);
  void add(std::string_view name, std::string_view unit, std::int64_t t_ns, double value);
  void add(ReportEvent event) { events_.push_back(std::move(event)); }
  /// A line of the table of health.
  void note(std::string what, std::string value);
  /// Blind times are the gaps between lists, where nobody has said so.
  void find_gaps(std::int64_t begin_ns, std::int64_t end_ns);

  HeightRaster& ground() { return ground_; }
  const std::vector<ObstacleList>& lists() const { return lists_; }

  /// Scores the lists.
  void compare_with(const Truth& truth);
  /// Everything in one block of bytes that the page reads: the length of a JSON text (4 bytes,
  /// least first), the text, and the numbers that it points to.
  std::vector<std::uint8_t> pack() const;

private:
  using Json = nlohmann::ordered_json;
  struct Sweep {
    std::size_t list;
    std::vector<std::int16_t> x, y, z;  // hundredths of a metre
  };
  struct GridFrame {
    std::int64_t t_ns;
    Eigen::Vector2d origin;
    double cell;
    std::size_t columns, rows;
    std::vector<std::uint8_t> state;
  };
  class Blob;

  std::int64_t begin_ns() const;
  double seconds(std::int64_t t_ns) const;
  Json lists_json() const;
  Json health_json() const;
  Json sweeps_json(Blob& blob) const;
  Json grids_json(Blob& blob) const;
  Json ground_json(Blob& blob) const;

  HeightRaster ground_{0.1};
  std::vector<ObstacleList> lists_;
  std::vector<Sweep> sweeps_;
  std::vector<GridFrame> grids_;
  std::vector<Series> series_;
  std::vector<ReportEvent> events_;
  std::vector<std::pair<std::string, std::string>> notes_;
  std::map<std::size_t, Json> comparisons_;  // by list
  Json truth_;
};

}  // namespace scree::cli
