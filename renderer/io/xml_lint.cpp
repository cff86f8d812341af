/// \file  A small XML tokenizer that only checks.
#include "renderer/io/xml_lint.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>
#include <string_view>

namespace plumb {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

bool is_name_character(char c) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    const bool digit = c >= '0' && c <= '9';
    // Bytes above 0x7F are parts of letters of other scripts.
    return letter || digit || c == '_' || c == ':' || c == '-' || c == '.' || (c & 0x80) != 0;
}

bool is_name_start(char c) {
    return is_name_character(c) && !(c >= '0' && c <= '9') && c != '-' && c != '.';
}

class Linter {
  public:
    explicit Linter(const XmlText& xml) : xml_(xml), text_(xml.text) {}

    void run() {
        while (skip_text()) {
            const std::string_view rest = text_.substr(position_);
            if (rest.starts_with("<!--"))
                skip_past("-->", "comment without an end (expected '-->')", 4);
            else if (rest.starts_with("<?"))
                skip_past("?>", "processing instruction without an end (expected '?>')", 2);
            else if (rest.starts_with("<!DOCTYPE"))
                refuse("a DOCTYPE is refused (scene files need no document type)");
            else if (rest.starts_with("<!"))
                refuse("a CDATA section or declaration is refused (expected an element)");
            else if (rest.starts_with("</"))
                closing_tag();
            else
                opening_tag();
        }
        if (depth_ > 0)
            truncated();
        if (!seen_root_)
            xml_.refuse(0, "no XML element in the file (expected <scene version=\"3.0.0\">)");
    }

  private:
    struct OpenElement {
        std::string_view name;
        std::size_t offset;
    };

    [[noreturn]] void refuse(const std::string& what) const { xml_.refuse(position_, what); }

    [[noreturn]] void truncated() const {
        if (depth_ == 0)
            xml_.refuse(text_.size(), "unexpected end of the file");
        const OpenElement& open = open_[depth_ - 1];
        const SourceLocation start = xml_.at(open.offset);
        xml_.refuse(text_.size(),
                    fmt::format("unexpected end of the file (expected </{}> for line {}:{})",
                                open.name, start.line, start.column));
    }

    [[nodiscard]] char peek() const {
        if (position_ >= text_.size())
            truncated();
        return text_[position_];
    }

    void skip_space() {
        while (position_ < text_.size() && is_space(text_[position_]))
            ++position_;
    }

    /// To the next '<'; false at the end of the file.
    bool skip_text() {
        skip_space();
        if (position_ >= text_.size())
            return false;
        if (text_[position_] != '<') {
            const std::size_t end = std::min(text_.find_first_of("<\n", position_), text_.size());
            const std::size_t length = std::min<std::size_t>(end - position_, 20);
            refuse(fmt::format("text between elements (got '{}', expected '<')",
                               text_.substr(position_, length)));
        }
        return true;
    }

    void skip_past(std::string_view end, const char* what, std::size_t start) {
        const std::size_t found = text_.find(end, position_ + start);
        if (found == std::string_view::npos)
            refuse(what);
        position_ = found + end.size();
    }

    std::string_view name(const char* expected) {
        const std::size_t start = position_;
        if (!is_name_start(peek()))
            refuse(fmt::format("bad XML (got '{}', expected {})", text_[position_], expected));
        while (position_ < text_.size() && is_name_character(text_[position_]))
            ++position_;
        return text_.substr(start, std::min<std::size_t>(position_ - start, 256));
    }

    void closing_tag() {
        const std::size_t start = position_;
        position_ += 2;
        const std::string_view closed = name("an element name");
        if (depth_ == 0 || open_[depth_ - 1].name != closed) {
            position_ = start;
            if (depth_ == 0)
                refuse(fmt::format("closing tag without an opening one (got </{}>)", closed));
            const SourceLocation opened = xml_.at(open_[depth_ - 1].offset);
            refuse(fmt::format("mismatched tags (got </{}>, expected </{}> for line {}:{})", closed,
                               open_[depth_ - 1].name, opened.line, opened.column));
        }
        skip_space();
        expect('>');
        --depth_;
    }

    void expect(char wanted) {
        if (peek() != wanted)
            refuse(fmt::format("bad XML (got '{}', expected '{}')", peek(), wanted));
        ++position_;
    }

    void opening_tag() {
        const std::size_t start = position_;
        ++position_;
        const std::string_view element = name("an element name");
        const auto refuse_element = [&](const std::string& what) { xml_.refuse(start, what); };
        if (depth_ == 0 && seen_root_)
            refuse_element(fmt::format("second root element (got <{}>, expected one)", element));
        if (depth_ == open_.size())
            refuse_element(
                fmt::format("elements nested too deeply (expected at most {})", max_xml_depth));
        if (++elements_ > max_xml_elements)
            refuse_element(
                fmt::format("too many elements (expected at most {})", max_xml_elements));
        seen_root_ = true;
        open_[depth_++] = {element, start};
        attributes();
        if (peek() == '/') {
            ++position_;
            --depth_;
        }
        expect('>');
    }

    void attributes() {
        std::array<std::string_view, max_xml_attributes> names;
        for (std::size_t count = 0;;) {
            const bool spaced = is_space(peek());
            skip_space();
            const char c = peek();
            if (c == '>' || c == '/')
                return;
            if (!spaced)
                refuse(fmt::format("bad XML (got '{}', expected a space, '/>' or '>')", c));
            const std::size_t start = position_;
            const std::string_view attribute = name("an attribute name");
            const auto end = names.begin() + static_cast<std::ptrdiff_t>(count);
            if (std::find(names.begin(), end, attribute) != end)
                xml_.refuse(start, fmt::format("attribute '{}' given twice", attribute));
            if (count == names.size())
                xml_.refuse(start, fmt::format("too many attributes (expected at most {})",
                                               max_xml_attributes));
            names[count++] = attribute;
            skip_space();
            expect('=');
            skip_space();
            value(attribute);
        }
    }

    void value(std::string_view attribute) {
        const char quote = peek();
        if (quote != '"' && quote != '\'')
            refuse(fmt::format("value of '{}' without quotes (got '{}', expected '\"')", attribute,
                               quote));
        const std::size_t start = ++position_;
        const std::size_t end = text_.find(quote, start);
        const std::string_view rest = text_.substr(start, end - start);
        const std::size_t bracket = rest.find('<');
        if (bracket != std::string_view::npos)
            xml_.refuse(
                start + bracket,
                fmt::format("'<' in the value of '{}' (a closing quote missing?)", attribute));
        if (end == std::string_view::npos)
            truncated();
        if (rest.size() > max_xml_value)
            xml_.refuse(start, fmt::format("value of '{}' too long (got {} bytes, expected at most "
                                           "{})",
                                           attribute, rest.size(), max_xml_value));
        for (std::size_t i = rest.find('&'); i != std::string_view::npos; i = rest.find('&', i + 1))
            entity(start + i, rest.substr(i + 1));
        position_ = end + 1;
    }

    /// `rest` begins behind the '&'.
    void entity(std::size_t offset, std::string_view rest) const {
        const std::string_view body = rest.substr(0, std::min<std::size_t>(rest.find(';'), 16));
        const bool ended = body.size() < rest.size() && rest[body.size()] == ';';
        constexpr std::array<std::string_view, 5> named{"lt", "gt", "amp", "apos", "quot"};
        const bool known = std::find(named.begin(), named.end(), body) != named.end();
        if (!ended || !(known || is_character_reference(body)))
            xml_.refuse(offset, fmt::format("undefined entity (got '&{}{}', expected &lt; &gt; "
                                            "&amp; &apos; &quot; or a character reference)",
                                            body, ended ? ";" : ""));
    }

    static bool is_character_reference(std::string_view body) {
        if (body.size() < 2 || body[0] != '#')
            return false;
        const bool hex = body[1] == 'x';
        const std::string_view digits = body.substr(hex ? 2 : 1);
        std::uint32_t code = 0;
        const char* const last = digits.data() + digits.size();
        const auto [end, error] = std::from_chars(digits.data(), last, code, hex ? 16 : 10);
        const bool parsed = end == last && error == std::errc{} && !digits.empty();
        const bool control = code < 0x20 && code != '\t' && code != '\n' && code != '\r';
        return parsed && !control && code <= 0x10FFFF && !(code >= 0xD800 && code < 0xE000);
    }

    const XmlText& xml_;
    std::string_view text_;
    std::size_t position_ = 0;
    std::array<OpenElement, max_xml_depth> open_{};
    std::size_t depth_ = 0;
    std::size_t elements_ = 0;
    bool seen_root_ = false;
};

} // namespace

void lint_xml(const XmlText& xml) { Linter(xml).run(); }

} // namespace plumb
