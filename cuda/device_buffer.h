/// \file  Memory of the device, owned.
#pragma once

#include "cuda/cuda_check.h"

#include <cstddef>
#include <span>
#include <type_traits>

namespace plumb {

/// `size` values of T on the current device, not initialised. Throws DeviceError, also where the
/// memory does not suffice.
template <class T> class DeviceBuffer {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    explicit DeviceBuffer(std::size_t size) : size_(size) {
        if (size > 0)
            RT_CUDA_CHECK(cudaMalloc(&data_, size * sizeof(T)));
    }
    DeviceBuffer(const DeviceBuffer&) = delete;
    DeviceBuffer& operator=(const DeviceBuffer&) = delete;
    ~DeviceBuffer() { cudaFree(data_); } // nothing to be done about an error here

    [[nodiscard]] T* data() { return static_cast<T*>(data_); }
    [[nodiscard]] std::size_t size() const { return size_; }

    /// Sets the first `count` values to zero bits.
    void clear(std::size_t count) { RT_CUDA_CHECK(cudaMemset(data_, 0, count * sizeof(T))); }
    /// Sets all bytes.
    void fill(int byte) { RT_CUDA_CHECK(cudaMemset(data_, byte, size_ * sizeof(T))); }
    /// Sets the first from.size() values.
    void copy_from(std::span<const T> from) {
        if (!from.empty())
            RT_CUDA_CHECK(
                cudaMemcpy(data_, from.data(), from.size_bytes(), cudaMemcpyHostToDevice));
    }
    /// Copies the first to.size() values to the host; waits for all kernels.
    void copy_to(std::span<T> to) const {
        if (!to.empty())
            RT_CUDA_CHECK(cudaMemcpy(to.data(), data_, to.size_bytes(), cudaMemcpyDeviceToHost));
    }

  private:
    void* data_ = nullptr;
    std::size_t size_;
};

} // namespace plumb
