#include "app/page_faults.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <optional>
#include <thread>

namespace scree {
namespace {

// What the kernel tells the thread itself is the reference.
TEST(PageFaults, AreThoseOfEachThread) {
  rusage before{}, after{};
  ThreadPageFaults faults;
  std::optional<PageFaults> found;
  EXPECT_FALSE(faults.read()) << "not open yet";
  std::thread thread([&] {
    pthread_setname_np(pthread_self(), "a) thread (b");
    faults.open();
    constexpr std::size_t kPages = 200;
    const auto page = static_cast<std::size_t>(getpagesize());
    void* const memory =
        mmap(nullptr, kPages * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(memory, MAP_FAILED);
    madvise(memory, kPages * page, MADV_NOHUGEPAGE);
    for (std::size_t i = 0; i < kPages; ++i) static_cast<volatile char*>(memory)[i * page] = 1;
    getrusage(RUSAGE_THREAD, &before);
    found = faults.read();
    getrusage(RUSAGE_THREAD, &after);
    munmap(memory, kPages * page);
  });
  thread.join();
  ASSERT_TRUE(found);
  EXPECT_GE(before.ru_minflt, 200);
  EXPECT_GE(found->minor, before.ru_minflt);
  EXPECT_LE(found->minor, after.ru_minflt);
  EXPECT_GE(found->major, before.ru_majflt);
  EXPECT_LE(found->major, after.ru_majflt);
  EXPECT_FALSE(faults.read()) << "the thread has ended";
}

TEST(PageFaults, AreReadFromTheirFields) {
  const auto faults =
      page_faults_in("100 (a) lidar (b) S 1 99 1 0 -1 4194368 12 7 3 0 1 2 0 0 20 0\n");
  ASSERT_TRUE(faults);
  EXPECT_EQ(faults->minor, 12);
  EXPECT_EQ(faults->major, 3);
  for (const char* line : {"", ")", "100 (lidar", "100 (lidar) S 1 99 1 0 -1 4194368 12 7",
                           "100 (lidar) S 1 99 1 0 -1 4194368 twelve 7 3"}) {
    EXPECT_FALSE(page_faults_in(line)) << line;
  }
}

}  // namespace
}  // namespace scree
