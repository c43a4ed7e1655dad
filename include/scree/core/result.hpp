#pragma once

#include <string>
#include <tl/expected.hpp>

namespace scree {

/// What went wrong, as one sentence for the person who has to mend it (no trailing full stop).
struct Error {
  std::string message;
};

/// A value, or the reason why there is none. For configuration, files and devices at start;
/// bad sensor bytes are data and come back as enums instead.
template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(std::string message) {
  return tl::make_unexpected(Error{std::move(message)});
}

}  // namespace scree
