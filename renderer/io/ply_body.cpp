/// \file  The values in the body of a PLY file, one after the other: ASCII and binary.
#include "renderer/io/ply_body.h"

#include "accel/math/vec.h"
#include "renderer/io/text_position.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

namespace plumb {

// --- ASCII ---------------------------------------------------------------------------------------

void PlyAsciiBody::begin_row() {
    do {
        if (!text_.next_line())
            text_.refuse("body is truncated (got the end of the file)");
    } while (text_.at_line_end());
}

const char* PlyAsciiBody::place() {
    static_cast<void>(text_.at_line_end()); // skips blanks
    return text_.at();
}

long long PlyAsciiBody::integer(PlyType) {
    const char* const at = place();
    if (text_.at_line_end())
        text_.refuse("row is too short (got the end of the line)");
    const auto value = text_.read_integer();
    if (!value || !text_.at_separator())
        text_.refuse(at, "invalid integer (got '" + printable(text_.token_from(at)) + "')");
    return *value;
}

void PlyAsciiBody::skip(PlyType, std::uint64_t count) {
    for (; count > 0; --count) {
        if (text_.at_line_end())
            text_.refuse("row is too short (got the end of the line)");
        text_.advance(text_.token().size());
    }
}

std::size_t PlyAsciiBody::trailing_bytes() {
    std::size_t bytes = 0;
    while (text_.next_line())
        for (; !text_.at_line_end(); text_.advance(text_.token().size()))
            bytes += text_.token().size();
    return bytes;
}

// --- binary --------------------------------------------------------------------------------------

PlyBinaryBody::PlyBinaryBody(std::string file, std::string_view text, std::string_view body,
                             PlyFormat format)
    : file_(std::move(file)), start_(text.data()), at_(body.data()), end_(at_ + body.size()),
      swap_bytes_((format == PlyFormat::little_endian) !=
                  (std::endian::native == std::endian::little)) {}

void PlyBinaryBody::refuse_at(const char* place, const std::string& what) const {
    throw SceneError(ErrorKind::mesh, {file_, 0, 0},
                     what + " at byte " + std::to_string(place - start_));
}

template <class Value> Value PlyBinaryBody::take() {
    if (left() < sizeof(Value))
        refuse_at(at_, "body is truncated");
    char bytes[sizeof(Value)];
    std::memcpy(bytes, at_, sizeof(Value));
    if (swap_bytes_)
        std::reverse(std::begin(bytes), std::end(bytes));
    at_ += sizeof(Value);
    Value value;
    std::memcpy(&value, bytes, sizeof(Value));
    return value;
}

long long PlyBinaryBody::integer(PlyType type) {
    switch (type) {
    case PlyType::int8: return take<std::int8_t>();
    case PlyType::uint8: return take<std::uint8_t>();
    case PlyType::int16: return take<std::int16_t>();
    case PlyType::uint16: return take<std::uint16_t>();
    case PlyType::int32: return take<std::int32_t>();
    default: return take<std::uint32_t>(); // the header has refused floats
    }
}

float PlyBinaryBody::number(PlyType type) {
    const char* const place = at_;
    if (is_integer(type))
        return static_cast<float>(integer(type));
    const double value =
        type == PlyType::float64 ? take<double>() : static_cast<double>(take<float>());
    if (!(std::fabs(value) <= static_cast<double>(max_coordinate)))
        refuse_at(place, "invalid number (got '" + std::to_string(value) +
                             "', expected a finite one of at most 1.8e18)");
    return static_cast<float>(value);
}

void PlyBinaryBody::skip(PlyType type, std::uint64_t count) {
    if (count > left() / size_of(type))
        refuse_at(at_, "body is truncated");
    at_ += count * size_of(type);
}

} // namespace plumb
