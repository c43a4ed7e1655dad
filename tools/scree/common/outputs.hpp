#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <initializer_list>
#include <vector>

namespace scree::cli {

/// What a command writes: nothing that is there is overwritten without --force.
class Outputs {
public:
  void add_to(CLI::App& command);
  bool are_forced() const { return force_; }

  /// Before the work begins: throws Failure where one of the files is there already, or its folder
  /// is not or cannot be written; with --force, too, where two of them are one file, or one of them
  /// is read. An empty name, a device and a pipe are always free.
  /// @param read files, or folders of captures
  void require_free(std::initializer_list<std::filesystem::path> files,
                    const std::vector<std::filesystem::path>& read = {}) const;
  /// The same for a folder that gets many files: it may be there, but empty.
  void require_empty(const std::filesystem::path& folder) const;
  /// Removes what an earlier run has written of its sweeps, so that those of two do not mix.
  static void remove_sweeps(const std::filesystem::path& folder);

private:
  bool force_ = false;
};

}  // namespace scree::cli
