/// \file  One block of memory on huge pages where the system has them.
///
/// A tree that is larger than the caches is walked at random: with 4 KB pages most steps miss the
/// translation buffer too.
#pragma once

#include <cstddef>

namespace plumb {

/// Uninitialised memory, aligned to `alignment`. Moves, does not copy.
class TreeMemory {
  public:
    static constexpr std::size_t alignment = 64;

    TreeMemory() = default;
    /// Throws std::bad_alloc.
    explicit TreeMemory(std::size_t bytes);
    TreeMemory(TreeMemory&& other) noexcept;
    TreeMemory& operator=(TreeMemory&& other) noexcept;
    TreeMemory(const TreeMemory&) = delete;
    TreeMemory& operator=(const TreeMemory&) = delete;
    ~TreeMemory();

    [[nodiscard]] std::byte* data() const { return data_; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

  private:
    std::byte* data_ = nullptr;
    std::size_t bytes_ = 0;
};

} // namespace plumb
