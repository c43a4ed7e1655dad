#include "live/health_json.hpp"

#include <nlohmann/json.hpp>

#include "live/health_words.hpp"

namespace scree::cli {
namespace {

// In the order that is written here, which JSON objects otherwise forget.
using Json = nlohmann::ordered_json;

Json json_of(const latency_t& latency) {
  return {{"p50_ms", latency.p50_ms}, {"p99_ms", latency.p99_ms}, {"max_ms", latency.max_ms}};
}

Json json_of(const sensor_health_t& sensor) {
  Json refused = Json::object();
  for (std::size_t i = 0; i < sensor.refused.size(); ++i) {
    refused[sensor.refused_reason[i]] = sensor.refused[i];
  }
  return {{"state", state_name(sensor.state)},
          {"source", sensor.source},
          {"messages", sensor.messages},
          {"rate", sensor.rate},
          {"expected_rate", sensor.expected_rate},
          {"lost", sensor.lost},
          {"kernel_drops", sensor.kernel_drops},
          {"refused", refused},
          {"clock", clock_name(sensor.clock)},
          {"clock_offset_s", sensor.clock_offset_s},
          {"clock_accuracy_ms", sensor.clock_accuracy_ms}};
}

Json counts_of(const health_t& health) {
  return {{"position_packets", health.position_packets},
          {"sweeps", health.sweeps},
          {"sweeps_dropped", health.sweeps_dropped},
          {"sweeps_empty", health.sweeps_empty},
          {"sweeps_not_covered", health.sweeps_not_covered},
          {"sweeps_slipped", health.sweeps_slipped},
          {"heading_resets", health.heading_resets},
          {"lists_published", health.lists_published},
          {"lists_failed", health.lists_failed},
          {"lists_dropped", health.lists_dropped},
          {"points_dropped", health.points_dropped},
          {"points_refused", health.points_refused},
          {"edge_points_dropped", health.edge_points_dropped},
          {"obstacles_dropped", health.obstacles_dropped},
          {"map_points_dropped", health.map_points_dropped},
          {"tracks_dropped", health.tracks_dropped},
          {"samples_dropped", health.samples_dropped},
          {"samples_refused", health.samples_refused}};
}

Json parts_of(const health_t& health) {
  Json stages = Json::object(), queues = Json::object(), threads = Json::object();
  for (const stage_t& stage : health.stages) stages[stage.name] = json_of(stage.time);
  for (const queue_t& queue : health.queues) {
    queues[queue.name] = {{"most", queue.most}, {"capacity", queue.capacity}};
  }
  for (const thread_t& thread : health.threads) {
    threads[thread.name] = {{"minor_faults", thread.minor_faults},
                            {"major_faults", thread.major_faults}};
  }
  return {{"stages", stages}, {"queues", queues}, {"threads", threads}};
}

}  // namespace

std::string health_json(const health_t& health) {
  Json json = {{"stamp_ns", health.stamp_ns},
               {"health", health.state == health_t::OK ? "ok" : "blind"},
               {"reason", health.reason},
               {"stop", health.stop != 0},
               {"lines_problem", health.lines_problem},
               {"version", health.version},
               {"setup", health.setup},
               {"lidar", json_of(health.lidar)},
               {"imu", json_of(health.imu)},
               {"encoder", json_of(health.encoder)},
               {"encoder_bus", health.encoder_bus},
               {"position_deviation", health.position_deviation},
               {"yaw_deviation", health.yaw_deviation},
               {"latency", json_of(health.latency)},
               {"detector_time", json_of(health.detector_time)},
               {"processor_temperature", health.processor_temperature}};
  json.update(counts_of(health));
  json.update(parts_of(health));
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace scree::cli
