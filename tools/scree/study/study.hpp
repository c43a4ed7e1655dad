#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "draw/drawing.hpp"
#include "scree/config/settings.hpp"
#include "scree/core/point_cloud.hpp"
#include "scree/detect/detector.hpp"
#include "training/data_set.hpp"
#include "training/worlds.hpp"

namespace scree::cli {

/// What every study is told.
struct StudyTask {
  std::filesystem::path out;          ///< folder, there
  std::filesystem::path config_file;  ///< beside which weights are looked for; or empty
  Settings settings;
  SeedRange seeds;           ///< terrains that nothing was trained on
  std::size_t training = 0;  ///< terrains to train on, where a study trains
  std::size_t points = 0;    ///< of a cloud
  double seconds = 0;        ///< of a drive
};

/// The detector's settings under a name.
struct Way {
  std::string name;
  DetectSettings detect;
};

/// The paper's way as printed, and ours as configured.
std::vector<Way> both_ways(const StudyTask& task);

/// A detector for these settings with the weights that they name. Throws Failure.
Detector detector_of(const DetectSettings& settings, const StudyTask& task);
std::vector<Detector> detectors_of(const std::vector<Way>& ways, const StudyTask& task);
/// Its answer to a cloud.
ObstacleList list_of(Detector& detector, PointView cloud);

/// Finds the clusters of a cloud; they are valid until the next call.
using FindClusters = std::function<ClusteredPoints(PointView cloud)>;
/// @param detector must outlive the function
FindClusters finder_of(Detector& detector);

/// What each way of finding clusters makes of the clouds of the same worlds, one for each way.
/// @param what the clusters are for, in the progress
std::vector<LabelledClusters> label_worlds(
    std::span<const FindClusters> ways,
    const std::function<CloudWorld(std::uint64_t seed)>& world_of, const SeedRange& seeds,
    const std::string& what);

/// Write into the task's folder and say so on stdout, a table with its text. Throw Failure.
void write_text(const StudyTask& task, const std::string& name, const std::string& text);
void write_table(const StudyTask& task, const std::string& name, const std::string& text);
void write_picture(const StudyTask& task, const std::string& name, Drawing& drawing);

// One file a study; each writes NAME.csv or NAME.txt and NAME.png.
void study_training(const StudyTask& task);
void study_clustering(const StudyTask& task);
void study_seed_distance(const StudyTask& task);
void study_stages(const StudyTask& task);
void study_result(const StudyTask& task);
void study_classifiers(const StudyTask& task);
void study_changes(const StudyTask& task);
void study_detection(const StudyTask& task);
void study_drives(const StudyTask& task);

}  // namespace scree::cli
