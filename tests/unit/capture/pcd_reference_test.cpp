#include <gtest/gtest.h>
#include <pcl/console/print.h>
#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <random>

#include "scree/capture/pcd.hpp"
#include "scree/core/pcl_cloud.hpp"
#include "unit/recordings.hpp"
#include "unit/temporary_folder.hpp"

namespace scree {
namespace {

namespace fs = std::filesystem;

bool is_same(float a, float b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

/// The coordinates in float, whatever the file has, as PCL's user would read them.
void expect_as_pcl(const fs::path& file) {
  const auto ours = read_pcd(file);
  ASSERT_TRUE(ours) << ours.error().message;
  pcl::PCLPointCloud2 blob;
  ASSERT_EQ(pcl::io::loadPCDFile(file.string(), blob), 0) << file;
  const auto offset = [&](const std::string& name) -> std::ptrdiff_t {
    for (const auto& field : blob.fields) {
      if (field.name == name)
        return field.datatype == pcl::PCLPointField::FLOAT32
                   ? static_cast<std::ptrdiff_t>(field.offset)
                   : -1;
    }
    return -1;
  };
  const std::ptrdiff_t x = offset("x"), y = offset("y"), z = offset("z");
  if (x < 0 || y < 0 || z < 0 || !ours->origin.isZero()) return;  // doubles: pcd_test has them
  ASSERT_EQ(ours->size(), blob.width * blob.height) << file;
  ASSERT_EQ(blob.data.size(), ours->size() * blob.point_step) << file;
  const auto value = [&](std::size_t i, std::ptrdiff_t at) {
    float read = 0;
    std::memcpy(&read, blob.data.data() + i * blob.point_step + at, sizeof read);
    return read;
  };
  std::size_t different = 0;
  for (std::size_t i = 0; i < ours->size(); ++i) {
    different += !is_same(ours->x[i], value(i, x)) || !is_same(ours->y[i], value(i, y)) ||
                 !is_same(ours->z[i], value(i, z));
  }
  EXPECT_EQ(different, 0U) << file;
}

TEST(PcdReference, ReadsTheSharedFilesAsPclDoes) {
  NEEDS("clouds");
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  std::size_t compared = 0;
  for (const auto& entry : fs::recursive_directory_iterator(SCREE_SHARED_DATA)) {
    // PCL crashes on lower-case types, and does not know a byte order mark.
    if (entry.path().extension() != ".pcd" ||
        entry.path().parent_path().filename() == "pcd_headers") {
      continue;
    }
    pcl::PCLPointCloud2 blob;
    if (pcl::io::loadPCDFile(entry.path().string(), blob) != 0) continue;  // nor does PCL
    expect_as_pcl(entry.path());
    ++compared;
  }
  EXPECT_GE(compared, 10U);
}

/// Repeats itself in places, as compression likes it, and has what is no number.
template <class Point>
pcl::PointCloud<Point> generated(std::size_t size, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> place(0, 20);
  pcl::PointCloud<Point> cloud;
  for (std::size_t i = 0; i < size; ++i) {
    Point point;
    const bool repeats = i > 0 && random() % 3 == 0;
    point.x = repeats ? cloud.back().x : place(random);
    point.y = random() % 50 == 0 ? NAN : random() % 4 == 0 ? 0 : place(random);
    point.z = random() % 60 == 0 ? INFINITY : place(random) * 1e-6F;
    cloud.push_back(point);
  }
  return cloud;
}

template <class Point>
void expect_all_kinds_as_pcl(std::size_t size, std::uint32_t seed) {
  const TemporaryFolder folder;
  const auto cloud = generated<Point>(size, seed);
  pcl::PCDWriter writer;
  ASSERT_EQ(writer.writeASCII((folder / "a.pcd").string(), cloud, 9), 0);
  ASSERT_EQ(writer.writeBinary((folder / "b.pcd").string(), cloud), 0);
  ASSERT_EQ(writer.writeBinaryCompressed((folder / "c.pcd").string(), cloud), 0);
  for (const char* name : {"a.pcd", "b.pcd", "c.pcd"}) expect_as_pcl(folder / name);
}

TEST(PcdReference, ReadsWhatPclWritesOfAnyPointType) {
  for (const std::size_t size : {1UL, 7UL, 300UL, 20'000UL}) {
    const auto seed = static_cast<std::uint32_t>(size);
    expect_all_kinds_as_pcl<pcl::PointXYZ>(size, seed);
    expect_all_kinds_as_pcl<pcl::PointXYZI>(size, seed + 1);
    expect_all_kinds_as_pcl<pcl::PointXYZRGBA>(size, seed + 2);
    expect_all_kinds_as_pcl<pcl::PointNormal>(size, seed + 3);
  }
}

TEST(PcdReference, ReadsHeadersOfOlderVersionsAsPclDoes) {
  const TemporaryFolder folder;
  const std::string lines = "DATA ascii\n1 2 3\n4 5 6\n";
  for (const std::string header : {
           "VERSION .5\nCOLUMNS x y z\nPOINTS 2\n",
           "VERSION .6\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nPOINTS 2\n",
           "FIELDS x y z\nWIDTH 1\nHEIGHT 2\nPOINTS 2\n",
       }) {
    expect_as_pcl(folder.write("older.pcd", header + lines));
  }
}

TEST(PcdReference, ReadsTheWordsOfAnAsciiFileAsPclDoes) {
  const TemporaryFolder folder;
  const std::string header =
      "VERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n";
  const std::string lines =
      "+1.5 -2e3 .25 7\n\n 1e-46 1e39 -1e400 8\n\tnan NaN -nan 9\n"
      "inf -inf 1.5 10\r\n-.5 1e5 00012.50 11\n3.4028235e38 1.17549435e-38 "
      "0.1 12\n";
  expect_as_pcl(
      folder.write("words.pcd", header + "WIDTH 6\nHEIGHT 1\nPOINTS 6\nDATA ascii\n" + lines));
}

TEST(PclCloud, GivesItsPointsAsOurs) {
  pcl::PointCloud<pcl::PointXYZI> cloud;
  pcl::PointXYZI point;
  point.x = 1, point.y = 2, point.z = 3, point.intensity = 4;
  cloud.push_back(point);
  const PointCloud ours = from_pcl(cloud);
  ASSERT_EQ(ours.size(), 1U);
  EXPECT_EQ(ours.z[0], 3);
  EXPECT_EQ(ours.reflectivity[0], 4);
  pcl::PointCloud<pcl::PointXYZ> bare;
  bare.push_back({5, 6, 7});
  EXPECT_EQ(from_pcl(bare).y[0], 6);
  EXPECT_EQ(from_pcl(bare).reflectivity[0], 0);
}

}  // namespace
}  // namespace scree
