/// \file  Typed access to properties.
#include "renderer/io/load_properties.h"

#include "renderer/io/colour_value.h"
#include "renderer/io/known_plugins.h"
#include "renderer/io/load_transform.h"
#include "renderer/io/nearest_name.h"
#include "renderer/io/parse_number.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <limits>
#include <unordered_set>

namespace plumb {
namespace {

constexpr std::array<std::string_view, 12> property_elements{
    "float", "integer", "boolean",  "string", "point",     "vector",
    "rgb",   "srgb",    "spectrum", "color",  "transform", "blackbody"};

template <class Names> bool contains(const Names& names, std::string_view name) {
    return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

std::string lower(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z')
            c = static_cast<char>(c - 'A' + 'a');
    return result;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t start = text.find_first_not_of(" \t\r\n");
    if (start == std::string_view::npos)
        return {};
    return text.substr(start, text.find_last_not_of(" \t\r\n") - start + 1);
}

std::string joined(std::initializer_list<std::string_view> names) {
    std::string list;
    for (const std::string_view name : names)
        list += (list.empty() ? "" : ", ") + std::string(name);
    return list;
}

} // namespace

std::string snake_case(std::string_view name) {
    std::string result;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const bool upper = name[i] >= 'A' && name[i] <= 'Z';
        const bool after_lower = i > 0 && name[i - 1] >= 'a' && name[i - 1] <= 'z';
        if (upper && after_lower)
            result += '_';
        result += upper ? static_cast<char>(name[i] - 'A' + 'a') : name[i];
    }
    return result;
}

Properties::Properties(LoadContext& context, const XmlNode& node) : context_(context), node_(node) {
    node.allow_only({"type", "id", "name"});
    entries_.reserve(node.children.size());
    std::unordered_set<std::string> names;
    for (const XmlNode& child : node.children) {
        Entry entry = make_entry(child);
        if (!entry.name.empty() && !names.insert(entry.name).second)
            child.refuse(child.require("name"),
                         fmt::format("property '{}' of {} given twice (first at {})", entry.name,
                                     title(), to_string(peek(entry.name)->element->location())));
        entries_.push_back(std::move(entry));
    }
}

Properties::Entry Properties::make_entry(const XmlNode& child) const {
    Entry entry{{}, &child, &child};
    const bool property = contains(property_elements, child.name);
    if (child.name == "ref") {
        child.allow_only({"id", "name"});
        entry.object = &context_.target_of(child);
    } else if (property) {
        if (child.name != "transform" && !child.children.empty())
            child.children.front().refuse(fmt::format("<{}> inside <{}> (expected a value only)",
                                                      child.children.front().name, child.name));
    } else if (!contains(object_elements(), child.name)) {
        std::vector<std::string_view> names(property_elements.begin(), property_elements.end());
        names.insert(names.end(), object_elements().begin(), object_elements().end());
        child.refuse(fmt::format("unknown element <{}> in {}{}", child.name, title(),
                                 did_you_mean(child.name, names)));
    }
    if (property)
        entry.name = snake_case(child.require("name").value);
    else
        entry.name = snake_case(child.value_or_empty("name"));
    // A name on <bsdf>, <emitter> and the like means nothing: several may share it.
    if (contains(object_elements(), entry.object->name) && entry.object->name != "texture")
        entry.name.clear();
    return entry;
}

const Properties::Entry* Properties::peek(std::string_view name) const {
    const auto found = std::find_if(entries_.begin(), entries_.end(),
                                    [&](const Entry& e) { return e.name == name; });
    return found == entries_.end() ? nullptr : &*found;
}

bool Properties::has(std::string_view name) const { return peek(name) != nullptr; }

const XmlNode* Properties::entry_element(std::string_view name) {
    known_.push_back(name);
    for (Entry& entry : entries_)
        if (entry.name == name) {
            entry.used = true;
            return entry.element;
        }
    return nullptr;
}

const XmlNode* Properties::take(std::string_view name,
                                std::initializer_list<std::string_view> elements) {
    const XmlNode* element = entry_element(name);
    if (element && !contains(elements, element->name))
        element->refuse(fmt::format("property '{}' of {} has the wrong type (got <{}>, expected "
                                    "<{}>)",
                                    name, title(), element->name, *elements.begin()));
    if (element && element->name == "transform")
        element->allow_only({"name"});
    else if (element && (element->name == "point" || element->name == "vector"))
        element->allow_only({"name", "value", "x", "y", "z"});
    else if (element)
        element->allow_only({"name", "value"});
    return element;
}

void Properties::refuse(std::string_view name, const std::string& expected) const {
    const XmlNode& element = *peek(name)->element;
    const XmlAttribute* value = element.find("value");
    if (!value)
        element.refuse(fmt::format("bad value of '{}' (expected {})", name, expected));
    element.refuse(*value, fmt::format("bad value of '{}' (got '{:.60}', expected {})", name,
                                       value->value, expected));
}

double Properties::number(std::string_view name, double fallback) {
    const XmlNode* element = take(name, {"float", "integer"});
    if (!element)
        return fallback;
    const auto value = parse_double(trimmed(element->require("value").value));
    constexpr double largest = static_cast<double>(std::numeric_limits<float>::max());
    if (!value || *value > largest || *value < -largest)
        refuse(name, "a finite decimal number");
    return *value;
}

double Properties::positive(std::string_view name, double fallback) {
    const double value = number(name, fallback);
    if (has(name) && !(static_cast<float>(value) > 0))
        refuse(name, "a number above 0");
    return value;
}

std::int64_t Properties::integer(std::string_view name, std::int64_t fallback, std::int64_t lowest,
                                 std::int64_t highest) {
    const XmlNode* element = take(name, {"integer"});
    if (!element)
        return fallback;
    const auto value = parse_int64(trimmed(element->require("value").value));
    if (!value || *value < lowest || *value > highest)
        refuse(name, fmt::format("an integer from {} to {}", lowest, highest));
    return *value;
}

bool Properties::boolean(std::string_view name, bool fallback) {
    const XmlNode* element = take(name, {"boolean"});
    if (!element)
        return fallback;
    const std::string value = lower(trimmed(element->require("value").value));
    if (value != "true" && value != "false")
        refuse(name, "true or false");
    return value == "true";
}

const XmlAttribute* Properties::string(std::string_view name) {
    const XmlNode* element = take(name, {"string"});
    return element ? &element->require("value") : nullptr;
}

std::size_t Properties::choice(std::string_view name, std::size_t fallback,
                               std::initializer_list<std::string_view> names) {
    const XmlAttribute* value = string(name);
    if (!value)
        return fallback;
    const auto found = std::find(names.begin(), names.end(), lower(value->value));
    if (found == names.end())
        refuse(name, "one of " + joined(names));
    return static_cast<std::size_t>(found - names.begin());
}

Vec3 Properties::point(std::string_view name, Vec3 fallback) {
    const XmlNode* element = take(name, {"point", "vector"});
    if (!element)
        return fallback;
    const auto v = parse_triple(*element, 0);
    const Vec3 p{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
    if (!is_finite(p))
        refuse(name, "coordinates within the range of float");
    return p;
}

Rgb Properties::unsupported_colour(const Entry& entry, Rgb fallback) {
    const XmlNode& object = *entry.object;
    const bool wavelengths = object.name == "spectrum" && object.find("value");
    const std::string_view kind = object.value_or_empty("type");
    std::string source = fmt::format("<{}>", object.name);
    if (wavelengths)
        source = "a spectrum of wavelengths";
    else if (!kind.empty())
        source = fmt::format("{} '{}'", object.name, kind);
    const std::string what =
        fmt::format("{} as '{}' of {} is not supported yet (supported: rgb, srgb, spectrum with "
                    "one value)",
                    source, entry.name, title());
    const float mean = wavelengths && context_.lenient() ? mean_of_spectrum(object) : 0;
    const Rgb colour = wavelengths ? Rgb{mean, mean, mean} : fallback;
    context_.unsupported(*entry.element, what,
                         fmt::format("taken as {} {} {}", colour.r, colour.g, colour.b));
    return colour;
}

Rgb Properties::colour(std::string_view name, Rgb fallback, float lowest, float highest) {
    const XmlNode* element = entry_element(name);
    if (!element)
        return fallback;
    const Entry& entry = *peek(name);
    const std::string_view kind = entry.object->name;
    const bool object = kind == "texture" || kind == "blackbody" || element->find("type") ||
                        element->find("filename");
    if (!object)
        take(name, {"rgb", "srgb", "color", "spectrum", "float"});
    const auto parsed = object ? std::nullopt : parse_colour(*element);
    Rgb colour = parsed ? *parsed : unsupported_colour(entry, fallback);
    const auto inside = [&](float c) { return c >= lowest && c <= highest; };
    if (inside(colour.r) && inside(colour.g) && inside(colour.b))
        return colour;
    const std::string expected = highest < std::numeric_limits<float>::max()
                                     ? fmt::format("values from {} to {}", lowest, highest)
                                     : fmt::format("values not below {}", lowest);
    if (!context_.lenient())
        refuse(name, expected);
    const auto clamped = [&](float c) { return std::clamp(c, lowest, highest); };
    colour = {clamped(colour.r), clamped(colour.g), clamped(colour.b)};
    context_.ignore(*element, fmt::format("'{}' of {} is out of range (expected {}); clamped to "
                                          "{} {} {}",
                                          name, title(), expected, colour.r, colour.g, colour.b));
    return colour;
}

Transform Properties::transform(std::string_view name) {
    const XmlNode* element = take(name, {"transform"});
    return element ? parse_transform(*element) : Transform{};
}

std::vector<const XmlNode*> Properties::objects(std::string_view element) {
    std::vector<const XmlNode*> found;
    for (Entry& entry : entries_)
        if (entry.object->name == element) {
            entry.used = true;
            found.push_back(entry.object);
        }
    return found;
}

void Properties::changes_no_pixel(std::initializer_list<std::string_view> names) {
    known_.insert(known_.end(), names.begin(), names.end());
    for (Entry& entry : entries_)
        if (!entry.used && contains(names, entry.name)) {
            entry.used = true;
            context_.ignore(*entry.element,
                            fmt::format("'{}' of {} changes no pixel", entry.name, title()));
        }
}

void Properties::not_supported(std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names)
        if (const XmlNode* element = entry_element(name))
            context_.unsupported(
                *element, fmt::format("property '{}' of {} is not supported yet", name, title()),
                "left out");
}

void Properties::ignore_rest() {
    for (Entry& entry : entries_)
        if (!entry.used) {
            entry.used = true;
            context_.ignore(*entry.element,
                            fmt::format("<{}> {}of {} left out", entry.element->name,
                                        entry.name.empty() ? "" : "'" + entry.name + "' ",
                                        title()));
        }
}

void Properties::finish() {
    for (const Entry& entry : entries_) {
        if (entry.used)
            continue;
        const XmlNode& element = *entry.element;
        if (!entry.name.empty())
            element.refuse(element.require("name"),
                           fmt::format("unknown property '{}' of {}{}", entry.name, title(),
                                       did_you_mean(entry.name, known_)));
        const bool reference = element.name == "ref";
        context_.unsupported(element,
                             fmt::format("<{}> {}in {} is not supported yet", entry.object->name,
                                         reference ? "by <ref> " : "", title()),
                             "left out");
    }
}

std::string Properties::title() const {
    return fmt::format("{} '{}'", node_.name, node_.value_or_empty("type"));
}

} // namespace plumb
