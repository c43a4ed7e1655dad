#include "app/page_faults.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

#include "unit/temporary_folder.hpp"

namespace scree {
namespace {

using ::testing::IsEmpty;

// What the kernel tells the thread itself is the reference.
TEST(PageFaults, AreThoseOfEachThread) {
  rusage before{}, after{};
  std::vector<PageFaults> all;
  std::thread thread([&] {
    pthread_setname_np(pthread_self(), "a) thread (b");
    constexpr std::size_t kPages = 200;
    const auto page = static_cast<std::size_t>(getpagesize());
    void* const memory =
        mmap(nullptr, kPages * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(memory, MAP_FAILED);
    madvise(memory, kPages * page, MADV_NOHUGEPAGE);
    for (std::size_t i = 0; i < kPages; ++i) static_cast<volatile char*>(memory)[i * page] = 1;
    getrusage(RUSAGE_THREAD, &before);
    all = page_faults();
    getrusage(RUSAGE_THREAD, &after);
    munmap(memory, kPages * page);
  });
  thread.join();
  const auto found = std::ranges::find(all, "a) thread (b", &PageFaults::thread);
  ASSERT_NE(found, all.end());
  EXPECT_GE(before.ru_minflt, 200);
  EXPECT_GE(found->minor, before.ru_minflt);
  EXPECT_LE(found->minor, after.ru_minflt);
  EXPECT_GE(found->major, before.ru_majflt);
  EXPECT_LE(found->major, after.ru_majflt);
}

TEST(PageFaults, AreReadFromTheirFieldsOldestThreadFirst) {
  const TemporaryFolder tasks;
  std::filesystem::create_directory(tasks / "100");
  std::filesystem::create_directory(tasks / "99");
  tasks.write("100/stat", "100 (lidar) S 1 99 1 0 -1 4194368 12 0 3 0 1 2 0 0 20 0");
  tasks.write("99/stat", "99 (screed) R 1 99 1 0 -1 4194368 500 7 0 0 1 2 0 0 20 0");
  const auto all = page_faults(tasks / "");
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].thread, "screed");
  EXPECT_EQ(all[0].minor, 500);
  EXPECT_EQ(all[0].major, 0);
  EXPECT_EQ(all[1].thread, "lidar");
  EXPECT_EQ(all[1].minor, 12);
  EXPECT_EQ(all[1].major, 3);
  EXPECT_THAT(page_faults(tasks / "none"), IsEmpty());
}

}  // namespace
}  // namespace scree
