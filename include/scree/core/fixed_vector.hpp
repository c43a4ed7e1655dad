#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <memory>
#include <type_traits>

namespace scree {

/// An array whose capacity is set once, when it is made, and whose memory is touched then, so that
/// filling it later neither allocates nor takes a page fault.
template <class T>
class FixedVector {
  static_assert(std::is_trivially_destructible_v<T>);

public:
  FixedVector() = default;
  explicit FixedVector(std::size_t capacity)
      : data_(std::make_unique<T[]>(capacity)), capacity_(capacity) {}

  std::size_t size() const { return size_; }
  std::size_t capacity() const { return capacity_; }
  bool empty() const { return size_ == 0; }
  bool full() const { return size_ == capacity_; }

  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  T* begin() { return data(); }
  T* end() { return data() + size_; }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size_; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  T& back() { return data_[size_ - 1]; }
  const T& back() const { return data_[size_ - 1]; }

  /// False when full; the value is then not taken.
  bool push_back(const T& value) {
    if (full()) return false;
    data_[size_++] = value;
    return true;
  }
  void clear() { size_ = 0; }
  /// Elements beyond the old size hold whatever was there. @pre size <= capacity()
  void resize(std::size_t size) {
    assert(size <= capacity_);
    size_ = size;
  }
  /// @pre other.size() <= capacity()
  void copy_from(const FixedVector& other) {
    resize(other.size());
    std::copy(other.begin(), other.end(), begin());
  }
  void assign(std::size_t size, const T& value) {
    resize(size);
    std::fill(begin(), end(), value);
  }

private:
  std::unique_ptr<T[]> data_;
  std::size_t capacity_ = 0;
  std::size_t size_ = 0;
};

}  // namespace scree
