#include "scree/capture/pcd.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pcl/PCLPointCloud2.h>
#include <pcl/io/pcd_io.h>

#include <cmath>
#include <cstring>
#include <random>

#include "unit/temporary_folder.hpp"

namespace scree {
namespace {

using ::testing::HasSubstr;

std::string header(const std::string& fields, const std::string& size, const std::string& type,
                   const std::string& points, const std::string& data) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + size + "\nTYPE " + type +
         "\nWIDTH " + points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " +
         data + "\n";
}

template <class... Values>
std::string packed(Values... values) {
  std::string bytes;
  const auto append = [&](auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  (append(values), ...);
  return bytes;
}

PointCloud sample(std::size_t size) {
  PointCloud cloud(size);
  for (std::size_t i = 0; i < size; ++i) {
    const float f = static_cast<float>(i);
    cloud.push_back(0.1F * f, -0.2F * f, std::sin(f), static_cast<float>(i % 256));
  }
  return cloud;
}

void expect_equal(const PointCloud& a, const PointCloud& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a.x[i], b.x[i]);
    EXPECT_EQ(a.y[i], b.y[i]);
    EXPECT_EQ(a.z[i], b.z[i]);
    EXPECT_EQ(a.reflectivity[i], b.reflectivity[i]);
  }
}

TEST(Pcd, WhatIsWrittenReadsBack) {
  const TemporaryFolder folder;
  for (const std::size_t size : {0U, 1U, 1000U}) {
    const PointCloud cloud = sample(size);
    ASSERT_TRUE(write_pcd(folder / "cloud.pcd", cloud));
    const auto read = read_pcd(folder / "cloud.pcd");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->capacity(), size);
    expect_equal(cloud, *read);
  }
}

TEST(Pcd, ReadsAllThreeKindsOfData) {
  const TemporaryFolder folder;
  const PointCloud cloud = sample(500);
  ASSERT_TRUE(write_pcd(folder / "binary.pcd", cloud));
  pcl::PCLPointCloud2 blob;
  ASSERT_EQ(pcl::io::loadPCDFile((folder / "binary.pcd").string(), blob), 0);
  const Eigen::Vector4f origin = Eigen::Vector4f::Zero();
  const Eigen::Quaternionf level = Eigen::Quaternionf::Identity();
  pcl::PCDWriter writer;
  ASSERT_EQ(writer.writeASCII((folder / "ascii.pcd").string(), blob, origin, level, 9), 0);
  ASSERT_EQ(writer.writeBinaryCompressed((folder / "compressed.pcd").string(), blob), 0);
  for (const char* name : {"ascii.pcd", "compressed.pcd"}) {
    const auto read = read_pcd(folder / name);
    ASSERT_TRUE(read) << read.error().message;
    expect_equal(cloud, *read);
  }
}

TEST(Pcd, ReadsDoublesAndAnyNumberForReflectivity) {
  const TemporaryFolder folder;
  const auto one = [&](const std::string& bytes) {
    const auto read = read_pcd(folder.write("cloud.pcd", bytes));
    EXPECT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->size(), 1U);
    EXPECT_EQ(read->x[0], 1.5F);
    EXPECT_EQ(read->y[0], -2.0F);
    EXPECT_EQ(read->z[0], 0.25F);
    return read->reflectivity[0];
  };
  EXPECT_EQ(one(header("x y z", "4 4 4", "F F F", "1", "binary") + packed(1.5F, -2.0F, 0.25F)),
            0.0F);
  EXPECT_EQ(one(header("x y z", "4 4 4", "F F F", "1", "ascii") + "1.5 -2 0.25\n"), 0.0F);
  EXPECT_EQ(one(header("i x z y", "1 8 8 8", "U F F F", "1", "binary") +
                packed(std::uint8_t{200}, 1.5, 0.25, -2.0)),
            200.0F);
  EXPECT_EQ(one(header("x y z reflectivity", "4 4 4 2", "F F F I", "1", "binary") +
                packed(1.5F, -2.0F, 0.25F, std::int16_t{-7})),
            -7.0F);
  EXPECT_EQ(
      one(header("x y z Intensity", "8 8 8 8", "F F F F", "1", "ascii") + "1.5 -2 0.25 99.5\n"),
      99.5F);
  EXPECT_EQ(one("VERSION 0.7\r\nFIELDS x y z _ intensity\r\nSIZE 4 4 4 1 4\r\nTYPE F F F U U\r\n"
                "COUNT 1 1 1 4 1\r\nWIDTH 1\r\nHEIGHT 1\r\nDATA binary\r\n" +
                packed(1.5F, -2.0F, 0.25F, std::uint32_t{0}, std::uint32_t{12})),
            12.0F);
}

TEST(Pcd, KeepsPointsThatAreNotFinite) {
  const TemporaryFolder folder;
  const auto read = read_pcd(folder.write(
      "cloud.pcd", header("x y z", "4 4 4", "F F F", "2", "ascii") + "nan nan nan\n1 2 3\n"));
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), 2U);
  EXPECT_TRUE(std::isnan(read->x[0]));
  EXPECT_EQ(read->z[1], 3.0F);
}

TEST(Pcd, WordsOfMicrosoftAndFractionsInWholeFieldsAreRead) {
  const TemporaryFolder folder;
  const auto read = read_pcd(
      folder.write("cloud.pcd", header("x y z intensity", "4 4 4 1", "F F F U", "2", "ascii") +
                                    "1.#QNAN -1.#IND 1.#INF 12.7\n1 2 3 200\n"));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(std::isnan(read->x[0]));
  EXPECT_TRUE(std::isnan(read->z[0]));
  EXPECT_EQ(read->reflectivity[0], 12);
  EXPECT_EQ(read->reflectivity[1], 200);
}

std::string error_of(const std::string& bytes) {
  const TemporaryFolder folder;
  const auto read = read_pcd(folder.write("bad.pcd", bytes));
  return read ? "no error" : read.error().message;
}

TEST(Pcd, EveryBadFileIsOneSentence) {
  const std::string point = packed(1.0F, 2.0F, 3.0F);
  const auto xyz = [](const std::string& points, const std::string& data) {
    return header("x y z", "4 4 4", "F F F", points, data);
  };
  EXPECT_THAT(read_pcd("/nonexistent/cloud.pcd").error().message, HasSubstr("No such file"));
  EXPECT_THAT(read_pcd("/tmp").error().message, HasSubstr("it is a folder"));
  EXPECT_THAT(error_of(""), HasSubstr("bad.pcd: is not a PCD file"));
  EXPECT_THAT(error_of("%PDF-1.7\nthis and that\n"), HasSubstr("is not a PCD file"));
  EXPECT_THAT(error_of("VERSION 0.7\nFIELDS x y"), HasSubstr("no DATA line"));
  EXPECT_THAT(error_of(xyz("2", "binary") + point),
              HasSubstr("is cut: 24 bytes of points, of which 12"));
  EXPECT_THAT(error_of(xyz("4000000000", "binary") + point), HasSubstr("bad WIDTH"));
  EXPECT_THAT(error_of(xyz("2000000000", "binary") + point), HasSubstr("is cut"));
  EXPECT_THAT(error_of(xyz("2000000000", "ascii") + "1 2 3\n"), HasSubstr("is cut"));
  EXPECT_THAT(error_of(xyz("1", "ascii") + "1,234 0,5 3\n"),
              HasSubstr("'1,234', which is no number, for point 1"));
  EXPECT_THAT(error_of(xyz("2", "ascii") + "1 2 3\n# here now yes\n4 5 6\n"),
              HasSubstr("'#', which is no number, for point 2"));
  EXPECT_THAT(error_of(xyz("3", "ascii") + "1.00 2.00 3.00\n 4.00 5.00 6.00 \n"),
              HasSubstr("bad.pcd: is cut: 2 of 3 points"));
  EXPECT_THAT(error_of(xyz("-1", "binary") + point), HasSubstr("bad WIDTH"));
  EXPECT_THAT(error_of(xyz("1", "hexadecimal") + point), HasSubstr("DATA"));
  EXPECT_THAT(error_of("FIELDS x y z\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 2 3\n"),
              HasSubstr("no WIDTH"));
  EXPECT_THAT(error_of(header("x y", "4 4", "F F", "1", "binary") + point),
              HasSubstr("no field z"));
  EXPECT_THAT(error_of(header("x y z", "4 4", "F F F", "1", "binary") + point),
              HasSubstr("one SIZE"));
  EXPECT_THAT(error_of(header("x y z", "4 4 3", "F F F", "1", "binary") + point),
              HasSubstr("field z"));
  EXPECT_THAT(error_of(header("x y z", "4 4 4", "F F U", "1", "binary") + point),
              HasSubstr("z that is not one float"));
  EXPECT_THAT(error_of(xyz("1000", "binary_compressed") + packed(4U, 12000U, 0U)),
              HasSubstr("compressed data of another size"));
  EXPECT_THAT(error_of(xyz("1", "binary_compressed") + packed(4U, 12U, 0xFFFFFFFFU)),
              HasSubstr("points that cannot be read"));
}

TEST(Pcd, MorePointsThanTheHeaderSaysAreNotLeftOutSilently) {
  const std::string point = packed(1.0F, 2.0F, 3.0F);
  const auto xyz = [](const std::string& data) {
    return header("x y z", "4 4 4", "F F F", "1", data);
  };
  EXPECT_THAT(error_of(xyz("binary") + point + point + point), HasSubstr("has 2 points more"));
  EXPECT_THAT(error_of(xyz("ascii") + "1 2 3\n4 5 6\n"), HasSubstr("has 1 points more"));
  EXPECT_EQ(error_of(xyz("ascii") + "1 2 3\n\n \n"), "no error");
  EXPECT_EQ(error_of(xyz("binary") + point + "\n"), "no error");
}

TEST(Pcd, ReadsHeadersOfAnyCaseAndPaddingOfAnySize) {
  const TemporaryFolder folder;
  const auto lower = read_pcd(
      folder.write("a.pcd",
                   "# .pcd v.7\nversion .7\nfields x y z\nsize 4 4 4\ntype f f f\nwidth 1\n"
                   "height 1\npoints 1\ndata ASCII\n1 2 3\n"));
  ASSERT_TRUE(lower) << lower.error().message;
  EXPECT_EQ(lower->z[0], 3);
  EXPECT_TRUE(is_pcd(folder / "a.pcd"));
  // A compressed file that has its padding, and points that would not become smaller.
  const std::string head =
      "VERSION 0.7\nFIELDS x _ y _ z\nSIZE 4 1 4 1 4\nTYPE F U F U F\nCOUNT 1 0 1 2 1\nWIDTH 1\n"
      "HEIGHT 1\nPOINTS 1\nDATA binary_compressed\n";
  const auto padded =
      read_pcd(folder.write("b.pcd", head + packed(14U, 14U, 1.0F, 2.0F, std::uint16_t{0}, 3.0F)));
  ASSERT_TRUE(padded) << padded.error().message;
  EXPECT_EQ(padded->x[0], 1);
  EXPECT_EQ(padded->y[0], 2);
  EXPECT_EQ(padded->z[0], 3);
}

TEST(Pcd, AFileOfAnotherKindIsNamed) {
  EXPECT_THAT(error_of("ply\nformat ascii 1.0\n"), HasSubstr("it is a point cloud (PLY)"));
  EXPECT_THAT(error_of("version https://git-lfs.github.com/spec/v1\n"), HasSubstr("git lfs pull"));
}

TEST(Pcd, TakesTheOriginOffInDoubleWhereACloudLiesFarFromIt) {
  const TemporaryFolder folder;
  const auto at = [&](double x, double y, double z) {
    return read_pcd(
        folder.write("far.pcd",
                     "VERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nWIDTH 3\nHEIGHT 1\n"
                     "VIEWPOINT 403000.5 5589000.25 1651 1 0 0 0\nPOINTS 3\nDATA binary\n" +
                         packed(x, y, z, x + 0.125, y, z, 1e300, std::nan(""), z)));
  };
  const auto far = at(403001.25, 5589001.5, 1650.5);
  ASSERT_TRUE(far) << far.error().message;
  EXPECT_EQ(far->origin, Eigen::Vector3d(403001, 5589002, 1651));
  EXPECT_EQ(far->x[0], 0.25F);
  EXPECT_EQ(far->x[1], 0.375F);
  EXPECT_EQ(far->y[0], -0.5F);
  EXPECT_EQ(far->z[0], -0.5F);
  EXPECT_EQ(far->viewpoint, Eigen::Vector3f(-0.5F, -1.75F, 0));
  EXPECT_EQ(at(90, -90, 1)->origin, Eigen::Vector3d::Zero());
}

TEST(Pcd, IsKnownByItsFirstWords) {
  const TemporaryFolder folder;
  EXPECT_TRUE(is_pcd(folder.write("a", header("x y z", "4 4 4", "F F F", "0", "ascii"))));
  EXPECT_TRUE(is_pcd(folder.write("b", "\xEF\xBB\xBFVERSION 0.7\n")));
  EXPECT_FALSE(is_pcd(folder.write("c.pcd", "\xD4\xC3\xB2\xA1")));
  EXPECT_FALSE(is_pcd(folder / "none.pcd"));
}

TEST(Pcd, WhatCannotBeWrittenIsSaid) {
  EXPECT_THAT(write_pcd("/dev/full", sample(10)).error().message,
              HasSubstr("cannot write /dev/full"));
  EXPECT_THAT(write_pcd("/nonexistent/a.pcd", sample(10)).error().message,
              HasSubstr("cannot write"));
}

TEST(Pcd, SurvivesGarbledFiles) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_pcd(folder / "binary.pcd", sample(50)));
  pcl::PCLPointCloud2 blob;
  ASSERT_EQ(pcl::io::loadPCDFile((folder / "binary.pcd").string(), blob), 0);
  pcl::PCDWriter writer;
  writer.writeASCII((folder / "ascii.pcd").string(), blob);
  writer.writeBinaryCompressed((folder / "compressed.pcd").string(), blob);
  std::mt19937 random(11);
  for (const char* name : {"binary.pcd", "ascii.pcd", "compressed.pcd"}) {
    const std::string whole = bytes_of(folder / name);
    for (int round = 0; round < 250; ++round) {
      std::string bytes =
          whole.substr(0, random() % 3 == 0 ? random() % whole.size() : whole.size());
      for (int flips = 0; flips < 3 && !bytes.empty(); ++flips) {
        const std::size_t where = random() % (random() % 2 == 0 ? bytes.size() : 200);
        bytes[std::min(where, bytes.size() - 1)] = static_cast<char>(random());
      }
      const auto read = read_pcd(folder.write("garbled.pcd", bytes));
      if (!read) {
        ASSERT_EQ(read.error().message.find('\n'), std::string::npos);
      }
    }
  }
}

}  // namespace
}  // namespace scree
