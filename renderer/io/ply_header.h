/// \file  The header of a PLY file (G. Turk, "The PLY Polygon File Format", 1994).
#pragma once

#include "renderer/io/line_cursor.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace plumb {

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class PlyFormat : std::uint8_t { ascii, little_endian, big_endian };

/// Bytes of one value in a binary body.
[[nodiscard]] std::size_t size_of(PlyType type);
[[nodiscard]] inline bool is_integer(PlyType type) { return type < PlyType::float32; }

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    std::optional<PlyType> count_type; ///< of a list
    const char* at = nullptr;          ///< the name's place in the text
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
    const char* count_at = nullptr; ///< the count's place in the text

    [[nodiscard]] const PlyProperty* find(std::string_view property) const;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;

    [[nodiscard]] const PlyElement* find(std::string_view element) const;
};

/// Reads the header; `text` then stands at the line `end_header`, the body being text.rest().
/// Refuses, at line and column: anything that is not `ply`, `format ascii|binary_little_endian|
/// binary_big_endian 1.0`, `comment`, `obj_info`, `element` or `property`; unknown types; list
/// counts that are no integers; a name given twice; more than 256 elements, or properties of one;
/// a missing end_header; and counts of elements for which the body has not enough bytes.
[[nodiscard]] PlyHeader read_ply_header(LineCursor& text);

} // namespace plumb
