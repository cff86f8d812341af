#include "accel/validate/replay.h"

#include <charconv>

namespace plumb {
namespace {

constexpr std::string_view blanks = " \t\r";

/// The records of a replay file, one line at a time, field by field.
class Reader {
  public:
    explicit Reader(std::string_view text) : rest_(text) { next_line(); }

    [[noreturn]] void fail(std::string_view what, std::string_view got,
                           std::string_view expected) const {
        throw ReplayError("line " + std::to_string(number_) + ": " + std::string(what) + " (got '" +
                          std::string(got) + "', expected " + std::string(expected) + ")");
    }

    /// Whether the present line begins with this word, which is then taken.
    bool take(std::string_view keyword) {
        if (first_word(line_).second != keyword || at_end_)
            return false;
        line_ = first_word(line_).first;
        return true;
    }
    void require(std::string_view keyword) {
        if (!take(keyword))
            fail("another record", at_end_ ? "end of file" : first_word(line_).second, keyword);
    }
    std::string_view word(std::string_view expected) {
        const auto [after, found] = first_word(line_);
        if (found.empty())
            fail("the line ends early", "", expected);
        line_ = after;
        return found;
    }
    /// The rest of the line, without blanks at its ends.
    std::string_view remainder() {
        const std::size_t begin = std::min(line_.find_first_not_of(blanks), line_.size());
        std::string_view text = line_.substr(begin);
        text = text.substr(0, text.find_last_not_of(blanks) + 1);
        line_ = {};
        return text;
    }
    template <class Value> Value id(std::string_view expected) {
        const std::string_view text = word(expected);
        Value value{};
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size())
            fail("bad number", text, expected);
        return value;
    }
    float real() {
        const std::string_view text = word("a hexadecimal float");
        float value = 0;
        const auto [end, error] =
            std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::hex);
        if (error != std::errc() || end != text.data() + text.size())
            fail("bad number", text, "a hexadecimal float");
        return value;
    }
    Vec3 point() {
        const float x = real(), y = real();
        return {x, y, real()};
    }
    /// One of the values 0 .. count-1 of an enumeration, by name.
    template <class Enum> Enum name(std::size_t count, std::string_view expected) {
        const std::string_view text = word(expected);
        for (std::size_t i = 0; i < count; ++i)
            if (name_of(static_cast<Enum>(i)) == text)
                return static_cast<Enum>(i);
        fail("unknown name", text, expected);
    }
    /// Nothing may be left on the line.
    void end_line() {
        if (const std::string_view left = remainder(); !left.empty())
            fail("too many fields", left, "the end of the line");
        next_line();
    }
    [[nodiscard]] bool at_end() const { return at_end_; }

  private:
    /// What follows the first word, and the word.
    static std::pair<std::string_view, std::string_view> first_word(std::string_view line) {
        const std::size_t begin = std::min(line.find_first_not_of(blanks), line.size());
        const std::size_t end = std::min(line.find_first_of(blanks, begin), line.size());
        return {line.substr(end), line.substr(begin, end - begin)};
    }
    /// To the next line that is neither empty nor a comment.
    void next_line() {
        do {
            at_end_ = rest_.empty();
            const std::size_t end = std::min(rest_.find('\n'), rest_.size());
            line_ = rest_.substr(0, end);
            rest_.remove_prefix(std::min(end + 1, rest_.size()));
            ++number_;
        } while (!at_end_ && (first_word(line_).second.empty() || line_.starts_with('#')));
    }

    std::string_view rest_, line_;
    std::size_t number_ = 0;
    bool at_end_ = false;
};

void parse_primitive(Reader& in, bool is_sphere, Replay& replay) {
    ReplayPrimitive p;
    p.is_sphere = is_sphere;
    p.geometry = in.id<std::uint32_t>("a geometry id");
    p.primitive = in.id<std::uint32_t>("a primitive id");
    if (is_sphere) {
        p.sphere.center = in.point();
        p.sphere.radius = in.real();
    } else {
        p.triangle.a = in.point();
        p.triangle.b = in.point();
        p.triangle.c = in.point();
    }
    if (!replay.primitives.empty()) {
        const ReplayPrimitive& last = replay.primitives.back();
        const auto ids = std::to_string(p.geometry) + " " + std::to_string(p.primitive);
        if (std::pair(p.geometry, p.primitive) <= std::pair(last.geometry, last.primitive))
            in.fail("ids out of order", ids, "ascending (geometry, primitive)");
        if (last.is_sphere && (!is_sphere || p.geometry != last.geometry))
            in.fail("a second geometry after the spheres", ids,
                    "spheres in one geometry, the last");
        if (is_sphere && !last.is_sphere && p.geometry == last.geometry)
            in.fail("triangles and spheres in one geometry", ids, "a geometry of its own");
    }
    in.end_line();
    replay.primitives.push_back(p);
}

void parse_answer(Reader& in, std::string_view side, bool any_hit, Hit& hit, bool& found) {
    in.require(side);
    if (any_hit) {
        const std::string_view said = in.word("blocked or free");
        if (said != "blocked" && said != "free")
            in.fail("unknown answer", said, "blocked or free");
        found = said == "blocked";
    }
    const std::string_view kind = in.word("hit or miss");
    if (kind == "hit") {
        hit.geometry = in.id<std::uint32_t>("a geometry id");
        hit.primitive = in.id<std::uint32_t>("a primitive id");
        hit.t = in.real();
        hit.u = in.real();
        hit.v = in.real();
    } else if (kind != "miss") {
        in.fail("unknown answer", kind, "hit or miss");
    }
    in.end_line();
}

void parse_ray(Reader& in, Replay& replay) {
    Disagreement d;
    d.kind = in.name<RayKind>(ray_kind_count, "camera, bounce or shadow");
    d.verdict.agreement = in.name<Agreement>(agreement_count, "the name of an agreement");
    d.verdict.culprit = in.name<Culprit>(4, "none, first, second or both");
    d.ray.origin = in.point();
    d.ray.tmin = in.real();
    d.ray.direction = in.point();
    d.ray.tmax = in.real();
    in.end_line();
    Answers& a = d.answers;
    a.any_hit = d.kind == RayKind::shadow;
    parse_answer(in, "first", a.any_hit, a.first, a.first_found);
    parse_answer(in, "second", a.any_hit, a.second, a.second_found);
    replay.rays.push_back(d);
}

/// `yes` or `no` by name.
bool parse_choice(Reader& in, std::string_view yes, std::string_view no) {
    const std::string_view text = in.word(yes);
    if (text != yes && text != no)
        in.fail("unknown name", text, std::string(yes) + " or " + std::string(no));
    return text == yes;
}

} // namespace

Replay parse_replay(std::string_view text) {
    Reader in(text);
    Replay replay;
    in.require("plumbline-replay");
    if (const std::string_view version = in.word("a version"); version != "1")
        in.fail("unknown version", version, "1");
    in.end_line();
    if (in.take("scene")) {
        replay.scene = in.remainder();
        in.end_line();
    }
    in.require("test");
    replay.triangle_test = parse_choice(in, "watertight", "moeller-trumbore")
                               ? TriangleTest::watertight
                               : TriangleTest::moeller_trumbore;
    in.end_line();
    in.require("pair");
    replay.first = in.name<AccelKind>(3, "naive, sah or embree");
    replay.second = in.name<AccelKind>(3, "naive, sah or embree");
    in.end_line();
    in.require("geometry");
    replay.whole_geometry = parse_choice(in, "whole", "concerned");
    in.end_line();
    for (;;) {
        if (in.take("triangle"))
            parse_primitive(in, false, replay);
        else if (in.take("sphere"))
            parse_primitive(in, true, replay);
        else
            break;
    }
    while (in.take("ray"))
        parse_ray(in, replay);
    in.require("end");
    in.end_line();
    if (!in.at_end())
        in.fail("text after the end", in.remainder(), "nothing");
    return replay;
}

} // namespace plumb
