/// \file  Values out of the bytes that a fuzzer makes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace plumb::fuzz {

/// Takes values one after the other; zeros where the bytes have ended.
class ByteReader {
  public:
    ByteReader(const std::uint8_t* data, std::size_t size) : at_(data), left_(size) {}

    [[nodiscard]] bool at_end() const { return left_ == 0; }
    /// The bits of a value of any plain type.
    template <class Value> [[nodiscard]] Value take() {
        Value value{};
        const std::size_t bytes = left_ < sizeof(Value) ? left_ : sizeof(Value);
        if (bytes > 0)
            std::memcpy(&value, at_, bytes);
        at_ += bytes;
        left_ -= bytes;
        return value;
    }
    /// 0 to count - 1.
    [[nodiscard]] std::uint32_t below(std::uint32_t count) { return take<std::uint8_t>() % count; }

  private:
    const std::uint8_t* at_;
    std::size_t left_;
};

} // namespace plumb::fuzz
