/// \file  Decoding and checking the characters of an XML file.
#include "renderer/io/xml_text.h"

#include "renderer/io/input_file.h"

#include <algorithm>
#include <fmt/format.h>
#include <string_view>

namespace plumb {
namespace {

unsigned byte_at(std::string_view text, std::size_t i) {
    return static_cast<unsigned char>(text[i]);
}

bool is_continuation(std::string_view text, std::size_t i) {
    return i < text.size() && (byte_at(text, i) & 0xC0u) == 0x80u;
}

/// Length of the UTF-8 sequence at `i`, 0 if it is malformed (Unicode 15, table 3-7).
std::size_t utf8_length(std::string_view text, std::size_t i) {
    const unsigned lead = byte_at(text, i);
    if (lead < 0x80)
        return 1;
    if (!is_continuation(text, i + 1))
        return 0;
    const unsigned second = byte_at(text, i + 1);
    if (lead >= 0xC2 && lead <= 0xDF)
        return 2;
    if (!is_continuation(text, i + 2))
        return 0;
    const bool overlong3 = lead == 0xE0 && second < 0xA0;
    const bool surrogate = lead == 0xED && second > 0x9F;
    if (lead >= 0xE0 && lead <= 0xEF)
        return overlong3 || surrogate ? 0 : 3;
    if (!is_continuation(text, i + 3))
        return 0;
    const bool overlong4 = lead == 0xF0 && second < 0x90;
    const bool too_large = lead == 0xF4 && second > 0x8F;
    return lead < 0xF0 || lead > 0xF4 || overlong4 || too_large ? 0 : 4;
}

void append_utf8(std::string& out, unsigned code) {
    const auto put = [&](unsigned value) { out += static_cast<char>(value); };
    if (code < 0x80) {
        put(code);
    } else if (code < 0x800) {
        put(0xC0u | (code >> 6));
        put(0x80u | (code & 0x3Fu));
    } else if (code < 0x10000) {
        put(0xE0u | (code >> 12));
        put(0x80u | ((code >> 6) & 0x3Fu));
        put(0x80u | (code & 0x3Fu));
    } else {
        put(0xF0u | (code >> 18));
        put(0x80u | ((code >> 12) & 0x3Fu));
        put(0x80u | ((code >> 6) & 0x3Fu));
        put(0x80u | (code & 0x3Fu));
    }
}

/// `bytes` includes the byte order mark.
std::string utf16_to_utf8(std::string_view bytes, bool big_endian, const XmlText& where) {
    const auto unit = [&](std::size_t i) {
        const unsigned first = byte_at(bytes, i), second = byte_at(bytes, i + 1);
        return big_endian ? (first << 8) | second : (second << 8) | first;
    };
    std::string out;
    out.reserve(bytes.size());
    for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
        unsigned code = unit(i);
        if (code >= 0xD800 && code < 0xE000) {
            const unsigned low = i + 3 < bytes.size() ? unit(i + 2) : 0;
            if (code >= 0xDC00 || low < 0xDC00 || low >= 0xE000)
                where.refuse(std::string::npos,
                             fmt::format("bad UTF-16 (got an unpaired surrogate at byte {})", i));
            code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
            i += 2;
        }
        append_utf8(out, code);
    }
    return out;
}

std::string to_utf8(std::string bytes, const XmlText& where) {
    const bool little = bytes.starts_with("\xFF\xFE"), big = bytes.starts_with("\xFE\xFF");
    if (little || big) {
        if (bytes.size() % 2 != 0)
            where.refuse(std::string::npos,
                         fmt::format("UTF-16 text of odd length (got {} bytes)", bytes.size()));
        return utf16_to_utf8(bytes, big, where);
    }
    if (bytes.starts_with("\xEF\xBB\xBF"))
        bytes.erase(0, 3);
    return bytes;
}

void index_lines(XmlText& xml) {
    const std::string_view text = xml.text;
    xml.line_starts.push_back(0);
    for (std::size_t end = text.find('\n'); end != std::string_view::npos;
         end = text.find('\n', end + 1))
        xml.line_starts.push_back(static_cast<std::uint32_t>(end + 1));
}

void check_characters(const XmlText& xml) {
    for (std::size_t i = 0; i < xml.text.size();) {
        const unsigned c = byte_at(xml.text, i);
        if (c >= 0x20 && c < 0x80) { // nearly always
            ++i;
            continue;
        }
        if (c < 0x20 && c != '\t' && c != '\n' && c != '\r')
            xml.refuse(i, c == 0 ? "NUL byte in XML (binary, or UTF-16 without its mark?)"
                                 : fmt::format("control character in XML (got 0x{:02x})", c));
        const std::size_t length = utf8_length(xml.text, i);
        if (length == 0)
            xml.refuse(i, fmt::format("bad UTF-8 (got byte 0x{:02x})", c));
        i += length;
    }
}

} // namespace

SourceLocation XmlText::at(std::size_t offset) const {
    if (line_starts.empty() || offset > text.size())
        return {file, 0, 0};
    const auto next = std::upper_bound(line_starts.begin(), line_starts.end(), offset);
    const auto line = static_cast<int>(next - line_starts.begin());
    return {file, line, static_cast<int>(offset - *(next - 1)) + 1};
}

void XmlText::refuse(std::size_t offset, const std::string& what) const {
    throw SceneError(ErrorKind::scene, at(offset), one_line(what), included_from);
}

std::string one_line(std::string text) {
    const auto is_control = [](char c) { return (c >= 0 && c < ' ') || c == 0x7F; };
    std::replace_if(text.begin(), text.end(), is_control, '?');
    return text;
}

XmlText read_xml_text(const std::filesystem::path& file,
                      const std::vector<SourceLocation>& included_from) {
    XmlText xml;
    xml.file = file.string();
    xml.included_from = included_from;
    xml.text = to_utf8(read_file(file, ErrorKind::scene, max_xml_bytes, included_from), xml);
    index_lines(xml);
    check_characters(xml);
    return xml;
}

} // namespace plumb
