#include "accel/sah/tree_memory.h"

#include <cstdlib>
#include <new>
#include <utility>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace plumb {
namespace {

constexpr std::size_t huge_page = std::size_t{1} << 21;

std::size_t round_up(std::size_t bytes, std::size_t multiple) {
    return (bytes + multiple - 1) / multiple * multiple;
}

} // namespace

TreeMemory::TreeMemory(std::size_t bytes) : bytes_(bytes) {
    if (bytes == 0)
        return;
    const std::size_t align = bytes >= huge_page ? huge_page : alignment;
    data_ = static_cast<std::byte*>(std::aligned_alloc(align, round_up(bytes, align)));
    if (data_ == nullptr)
        throw std::bad_alloc();
#ifdef __linux__
    if (bytes >= huge_page)
        madvise(data_, round_up(bytes, align), MADV_HUGEPAGE); // a wish: no matter if it fails
#endif
}

TreeMemory::TreeMemory(TreeMemory&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}

TreeMemory& TreeMemory::operator=(TreeMemory&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(bytes_, other.bytes_);
    return *this;
}

TreeMemory::~TreeMemory() { std::free(data_); }

} // namespace plumb
