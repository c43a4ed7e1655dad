#include "report/report_data.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "detection/score_text.hpp"
#include "scree/core/rotation.hpp"

namespace scree::cli {
namespace {

using PageJson = nlohmann::ordered_json;

constexpr std::size_t kMostSweepPoints = 2'200'000;  // of all sweeps
constexpr std::size_t kMostOfSweep = 2'000;
constexpr std::size_t kMostCells = 4'000'000;
constexpr std::int64_t kGridPauseNs = 500'000'000;
constexpr std::int64_t kBlindNs = 300'000'000;

double to_digits(double value, double scale) {
  return std::round(value * scale) / scale;
}
double millimetres(double value) {
  return to_digits(value, 1e3);
}

template <class Vector>
PageJson numbers(const Vector& vector, double scale = 1e3) {
  PageJson json = PageJson::array();
  for (const double value : vector) json.push_back(to_digits(value, scale));
  return json;
}

std::int16_t hundredths(double metres) {
  constexpr double kMost = std::numeric_limits<std::int16_t>::max();
  return static_cast<std::int16_t>(std::clamp(std::round(metres * 100), -kMost, kMost));
}

/// In the order that the page knows.
PageJson row_of(const Obstacle& it) {
  PageJson corners = PageJson::array();
  for (const Eigen::Vector2d& corner : outline_of(it)) {
    corners.push_back(to_digits(corner.x(), 100));
    corners.push_back(to_digits(corner.y(), 100));
  }
  return {it.id,
          it.kind == ObstacleKind::positive ? 1 : -1,
          to_digits(it.confidence, 100),
          numbers(it.center),
          numbers(it.extent),
          millimetres(it.yaw),
          millimetres(it.height),
          to_digits(it.velocity.x(), 100),
          to_digits(it.velocity.y(), 100),
          it.points,
          it.evidence == Evidence::none ? "" : name(it.evidence),
          corners};
}

PageJson json_of_obstacle(const TrueObstacle& it) {
  PageJson outline = PageJson::array();
  for (const Eigen::Vector2d& corner : it.footprint) outline.push_back(numbers(corner));
  return {{"id", it.id},
          {"kind", it.kind == ObstacleKind::positive ? 1 : -1},
          {"shape", it.shape},
          {"height", millimetres(it.height)},
          {"center", numbers(it.center)},
          {"outline", outline}};
}

/// Where the truth's frame lies in the frame of a list, as the scoring lays them: x, y, yaw.
PageJson truth_in_odom(const Truth& truth, const ObstacleList& list) {
  const Pose pose = list.pose * truth.pose_at(list.stamp_ns).inverse();
  return {millimetres(pose.translation.x()), millimetres(pose.translation.y()),
          to_digits(yaw_of(pose.rotation), 1e5)};
}

}  // namespace

/// Numbers behind the text, by their place.
class ReportData::Blob {
public:
  /// @return where they begin, and how many bytes they take
  template <class Number>
  Json add(const std::vector<Number>& values) {
    static_assert(std::endian::native == std::endian::little,
                  "the page reads the least byte first");
    const std::size_t begin = bytes_.size();
    const auto bytes = std::as_bytes(std::span(values));
    bytes_.resize(begin + bytes.size());
    std::ranges::transform(bytes, bytes_.begin() + static_cast<std::ptrdiff_t>(begin),
                           [](std::byte byte) { return std::to_integer<std::uint8_t>(byte); });
    return {begin, bytes.size()};
  }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

private:
  std::vector<std::uint8_t> bytes_;
};

void ReportData::add(const ObstacleList& list) {
  ObstacleList& copy = lists_.emplace_back(list.obstacles.size());
  copy.stamp_ns = list.stamp_ns;
  copy.pose = list.pose;
  for (const Obstacle& obstacle : list.obstacles) copy.obstacles.push_back(obstacle);
}

void ReportData::add_sweep(const PointView& points) {
  Sweep& sweep = sweeps_.emplace_back();
  sweep.list = lists_.size() - 1;
  const std::size_t step = std::max<std::size_t>(1, points.size() / kMostOfSweep);
  for (std::size_t i = 0; i < points.size(); i += step) {
    sweep.x.push_back(hundredths(points.x[i]));
    sweep.y.push_back(hundredths(points.y[i]));
    sweep.z.push_back(hundredths(points.z[i]));
  }
}

void ReportData::add(const ObstacleGrid& grid) {
  if (!grids_.empty() && grid.stamp_ns < grids_.back().t_ns + kGridPauseNs) return;
  GridFrame& frame = grids_.emplace_back();
  frame = {grid.stamp_ns, grid.origin, grid.cell_size, grid.columns, grid.rows, {}};
  for (const CellState state : grid.state) frame.state.push_back(static_cast<std::uint8_t>(state));
}

void ReportData::add(std::string_view name, std::string_view unit, std::int64_t t_ns,
                     double value) {
  if (!std::isfinite(value)) return;
  auto at = std::ranges::find(series_, name, &Series::name);
  if (at == series_.end()) {
    series_.push_back({std::string(name), std::string(unit), {}, {}});
    at = series_.end() - 1;
  }
  at->add(t_ns, value);
}

void ReportData::note(std::string what, std::string value) {
  notes_.emplace_back(std::move(what), std::move(value));
}

void ReportData::find_gaps(std::int64_t begin_ns, std::int64_t end_ns) {
  std::int64_t last_ns = begin_ns;
  const auto see = [&](std::int64_t now_ns, const char* text) {
    if (now_ns - last_ns > kBlindNs) events_.push_back({"blind", text, last_ns, now_ns});
    last_ns = now_ns;
  };
  for (const ObstacleList& list : lists_) {
    see(list.stamp_ns, last_ns == begin_ns ? "no list yet" : "no list came");
  }
  see(end_ns, "no list came until the end");
}

void ReportData::compare_with(const Truth& truth) {
  Scorer scorer;
  scorer.add(truth, lists_, [&](const ObstacleList& list, const Comparison& comparison) {
    Json right = Json::array(), missed = Json::array(), invented = Json::array();
    for (const Comparison::Asked& asked : comparison.asked) {
      if (asked.is_right()) {
        right.push_back({asked.obstacle->id, asked.detection->id});
      } else {
        missed.push_back(asked.obstacle->id);
      }
    }
    for (const auto& alarm : comparison.false_alarms) invented.push_back(alarm.detection->id);
    const auto number = static_cast<std::size_t>(&list - lists_.data());
    comparisons_[number] = {{"right", right},
                            {"missed", missed},
                            {"invented", invented},
                            {"truth", truth_in_odom(truth, list)}};
  });
  truth_ = {{"score", Json::parse(score_json(scorer.result()))}};
  for (const TrueObstacle& each : truth.obstacles) {
    Json obstacle = json_of_obstacle(each);
    for (const auto& place : each.track) {
      obstacle["track"].push_back({seconds(place.t_ns), millimetres(place.position.x()),
                                   millimetres(place.position.y()), to_digits(place.yaw, 1e3)});
    }
    truth_["obstacles"].push_back(obstacle);
  }
}

std::int64_t ReportData::begin_ns() const {
  std::int64_t begin = std::numeric_limits<std::int64_t>::max();
  if (!lists_.empty()) begin = lists_.front().stamp_ns;
  for (const Series& series : series_) begin = std::min(begin, series.t_ns.front());
  for (const ReportEvent& event : events_) begin = std::min(begin, event.from_ns);
  return begin;
}

double ReportData::seconds(std::int64_t t_ns) const {
  return millimetres(static_cast<double>(t_ns - begin_ns()) * 1e-9);
}

ReportData::Json ReportData::lists_json() const {
  Json all = Json::array();
  for (std::size_t i = 0; i < lists_.size(); ++i) {
    const ObstacleList& list = lists_[i];
    const Eigen::Quaterniond& q = list.pose.rotation;
    Json obstacles = Json::array();
    for (const Obstacle& obstacle : list.obstacles) obstacles.push_back(row_of(obstacle));
    Json json = {{"t", seconds(list.stamp_ns)},
                 {"p", numbers(list.pose.translation)},
                 {"q", numbers(std::array{q.w(), q.x(), q.y(), q.z()}, 1e5)},
                 {"obstacles", obstacles}};
    if (const auto at = comparisons_.find(i); at != comparisons_.end()) json.update(at->second);
    all.push_back(std::move(json));
  }
  return all;
}

ReportData::Json ReportData::health_json() const {
  Json series = Json::array(), events = Json::array(), notes = Json::array();
  for (const Series& each : series_) {
    Json times = Json::array();
    for (const std::int64_t t_ns : each.t_ns) times.push_back(seconds(t_ns));
    series.push_back(
        {{"name", each.name}, {"unit", each.unit}, {"t", times}, {"v", numbers(each.values)}});
  }
  for (const ReportEvent& event : events_) {
    events.push_back({{"kind", event.kind},
                      {"text", event.text},
                      {"from", seconds(event.from_ns)},
                      {"to", seconds(event.to_ns)}});
  }
  for (const auto& [what, value] : notes_) notes.push_back({what, value});
  return {{"series", series}, {"events", events}, {"notes", notes}};
}

ReportData::Json ReportData::sweeps_json(Blob& blob) const {
  std::size_t points = 0;
  for (const Sweep& sweep : sweeps_) points += sweep.x.size();
  const std::size_t step = points / kMostSweepPoints + 1;
  Json lists = Json::array(), counts = Json::array();
  std::vector<std::int16_t> x, y, z;
  for (const Sweep& sweep : sweeps_) {
    const std::size_t before = x.size();
    for (std::size_t i = 0; i < sweep.x.size(); i += step) {
      x.push_back(sweep.x[i]);
      y.push_back(sweep.y[i]);
      z.push_back(sweep.z[i]);
    }
    lists.push_back(sweep.list);
    counts.push_back(x.size() - before);
  }
  return {{"lists", lists},
          {"counts", counts},
          {"x", blob.add(x)},
          {"y", blob.add(y)},
          {"z", blob.add(z)}};
}

ReportData::Json ReportData::grids_json(Blob& blob) const {
  Json grids = Json::array();
  for (const GridFrame& grid : grids_) {
    grids.push_back({{"t", seconds(grid.t_ns)},
                     {"origin", numbers(grid.origin)},
                     {"cell", grid.cell},
                     {"columns", grid.columns},
                     {"rows", grid.rows},
                     {"state", blob.add(grid.state)}});
  }
  return grids;
}

ReportData::Json ReportData::ground_json(Blob& blob) const {
  HeightGrid grid = ground_.grid(kMostCells);
  if (grid.columns == 0) return nullptr;
  fill_gaps(grid, 2);
  constexpr std::int16_t kNone = std::numeric_limits<std::int16_t>::min();
  std::vector<std::int16_t> heights;
  for (const float height : grid.heights) {
    heights.push_back(std::isfinite(height) ? hundredths(height) : kNone);
  }
  return {{"x", grid.x},       {"y", grid.y},
          {"cell", grid.cell}, {"columns", grid.columns},
          {"rows", grid.rows}, {"heights", blob.add(heights)}};
}

std::vector<std::uint8_t> ReportData::pack() const {
  Blob blob;
  Json json = {{"version", SCREE_VERSION},
               {"title", title},
               {"source", source},
               {"begin_ns", std::to_string(begin_ns())},
               {"stop", stop ? Json{{"length", stop->length}, {"width", stop->width}} : Json()},
               {"lists", lists_json()},
               {"health", health_json()},
               {"truth", truth_},
               {"ground", ground_json(blob)},
               {"grids", grids_json(blob)},
               {"sweeps", sweeps_json(blob)}};
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(4 + text.size() + blob.bytes().size());
  for (int shift = 0; shift < 32; shift += 8) {
    bytes.push_back(static_cast<std::uint8_t>(text.size() >> shift & 0xFF));
  }
  bytes.insert(bytes.end(), text.begin(), text.end());
  bytes.insert(bytes.end(), blob.bytes().begin(), blob.bytes().end());
  return bytes;
}

}  // namespace scree::cli
