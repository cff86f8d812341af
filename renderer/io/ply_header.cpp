/// \file  The header of a PLY file.
#include "renderer/io/ply_header.h"

#include "renderer/io/parse_number.h"
#include "renderer/io/text_position.h"

#include <algorithm>
#include <utility>

namespace plumb {
namespace {

constexpr std::size_t max_names = 256; ///< keeps the search for doubles cheap

constexpr std::pair<std::string_view, PlyType> type_names[] = {
    {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
    {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
    {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
    {"float64", PlyType::float64}};

template <class Named>
const Named* find_name(const std::vector<Named>& all, std::string_view name) {
    const auto it =
        std::find_if(all.begin(), all.end(), [&](const Named& n) { return n.name == name; });
    return it == all.end() ? nullptr : &*it;
}

/// Reads the lines of one header.
class HeaderReader {
  public:
    explicit HeaderReader(LineCursor& text) : text_(text) {}
    [[nodiscard]] PlyHeader read();

  private:
    void read_magic();
    void read_format();
    void read_element();
    void read_property();
    void check_counts() const;
    [[nodiscard]] PlyType read_type();
    [[nodiscard]] std::string_view word(const char* expected);
    template <class Named> [[nodiscard]] Named& add(std::vector<Named>& all, const char* what);

    LineCursor& text_;
    PlyHeader header_;
};

/// The next word of the line, skipped.
std::string_view HeaderReader::word(const char* expected) {
    if (text_.at_line_end())
        text_.refuse(std::string("header line is too short (expected ") + expected + ")");
    const std::string_view token = text_.token();
    text_.advance(token.size());
    return token;
}

void HeaderReader::read_magic() {
    if (!text_.next_line() || text_.token() != "ply")
        text_.refuse("no PLY file (got '" + printable(text_.token()) + "', expected 'ply')");
    text_.advance(3);
    text_.expect_line_end("'ply' alone");
}

void HeaderReader::read_format() {
    const std::string_view name = word("a format");
    if (name == "ascii")
        header_.format = PlyFormat::ascii;
    else if (name == "binary_little_endian")
        header_.format = PlyFormat::little_endian;
    else if (name == "binary_big_endian")
        header_.format = PlyFormat::big_endian;
    else
        text_.refuse(name.data(), "unknown PLY format (got '" + printable(name) +
                                      "', expected ascii, binary_little_endian or "
                                      "binary_big_endian)");
    const std::string_view version = word("the version 1.0");
    if (version != "1.0")
        text_.refuse(version.data(),
                     "unsupported PLY version (got '" + printable(version) + "', expected 1.0)");
}

/// A new entry of `all`, named by the next word.
template <class Named> Named& HeaderReader::add(std::vector<Named>& all, const char* what) {
    const std::string_view name = word("a name");
    if (find_name(all, name))
        text_.refuse(name.data(),
                     std::string(what) + " is given twice (got '" + printable(name) + "')");
    if (all.size() == max_names)
        text_.refuse(name.data(), std::string("too many (expected at most 256): ") + what);
    all.emplace_back().name = name;
    return all.back();
}

void HeaderReader::read_element() {
    PlyElement& element = add(header_.elements, "element");
    const std::string_view count = word("a count");
    const auto value = parse_uint64(count);
    if (!value)
        text_.refuse(count.data(), "invalid count of elements (got '" + printable(count) +
                                       "', expected an unsigned integer)");
    element.count = *value;
    element.count_at = count.data();
}

PlyType HeaderReader::read_type() {
    const std::string_view name = word("a type");
    for (const auto& [known, type] : type_names)
        if (name == known)
            return type;
    text_.refuse(name.data(), "unknown PLY type (got '" + printable(name) +
                                  "', expected char, uchar, short, ushort, int, uint, float or "
                                  "double)");
}

void HeaderReader::read_property() {
    if (header_.elements.empty())
        text_.refuse("property before the first element");
    static_cast<void>(text_.at_line_end()); // skips blanks
    std::optional<PlyType> count_type;
    if (text_.token() == "list") {
        text_.advance(4);
        static_cast<void>(text_.at_line_end());
        const char* const at = text_.at();
        count_type = read_type();
        if (!is_integer(*count_type))
            text_.refuse(at, "list count is no integer (expected an integer type)");
    }
    const PlyType type = read_type();
    static_cast<void>(text_.at_line_end());
    const char* const at = text_.at();
    PlyProperty& property = add(header_.elements.back().properties, "property");
    property.type = type;
    property.count_type = count_type;
    property.at = at;
}

/// That the body has room for what the header promises, before anything is allocated.
void HeaderReader::check_counts() const {
    const bool ascii = header_.format == PlyFormat::ascii;
    std::size_t left = text_.rest().size() + (ascii ? 1 : 0); // the last newline may be missing
    for (const PlyElement& element : header_.elements) {
        std::size_t row = 0;
        for (const PlyProperty& p : element.properties)
            row += ascii ? 2 : size_of(p.count_type.value_or(p.type)); // a digit and a blank
        if (row > 0 && element.count > left / row)
            text_.refuse(element.count_at,
                         "too few bytes for element '" + printable(element.name) + "' (got " +
                             std::to_string(left) + ", expected at least " +
                             std::to_string(element.count) + " times " + std::to_string(row) + ")");
        left -= element.count * row;
    }
}

PlyHeader HeaderReader::read() {
    read_magic();
    bool has_format = false;
    while (text_.next_line()) {
        if (text_.at_line_end())
            continue;
        const char* const at = text_.at();
        const std::string_view keyword = word("a keyword");
        if (keyword == "comment" || keyword == "obj_info")
            continue;
        if (keyword == "format" && !has_format) {
            read_format();
            has_format = true;
        } else if (!has_format) {
            text_.refuse(at,
                         "format is missing (got '" + printable(keyword) + "', expected 'format')");
        } else if (keyword == "element") {
            read_element();
        } else if (keyword == "property") {
            read_property();
        } else if (keyword == "end_header") {
            text_.expect_line_end("'end_header' alone");
            check_counts();
            return std::move(header_);
        } else {
            text_.refuse(at, "unknown header line (got '" + printable(keyword) +
                                 "', expected element, property or end_header)");
        }
        text_.expect_line_end("the end of the line");
    }
    text_.refuse("end_header is missing (got the end of the file)");
}

} // namespace

std::size_t size_of(PlyType type) {
    switch (type) {
    case PlyType::int8:
    case PlyType::uint8: return 1;
    case PlyType::int16:
    case PlyType::uint16: return 2;
    case PlyType::float64: return 8;
    default: return 4;
    }
}

const PlyProperty* PlyElement::find(std::string_view property) const {
    return find_name(properties, property);
}

const PlyElement* PlyHeader::find(std::string_view element) const {
    return find_name(elements, element);
}

PlyHeader read_ply_header(LineCursor& text) { return HeaderReader(text).read(); }

} // namespace plumb
