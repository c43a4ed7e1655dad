#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace scree {

/// A real recording, kept outside the project.
inline std::filesystem::path shared(const std::string& name) {
  return std::filesystem::path(SCREE_SHARED_DATA) / name;
}

}  // namespace scree

/// Skips the test where the recording is not there.
#define NEEDS(file)                                                             \
  if (!std::filesystem::exists(scree::shared(file))) {                          \
    GTEST_SKIP() << "the recording " << scree::shared(file) << " is not there"; \
  }
