/// \file  The properties of one plugin in a scene file, each asked for once and by type.
#pragma once

#include "renderer/io/load_context.h"

#include <optional>

namespace plumb {

/// `maxDepth` -> `max_depth`: what all dialects mean by a property's name.
[[nodiscard]] std::string snake_case(std::string_view name);

/// Reads an object element such as <shape type="...">. Ask for every property and nested object
/// that the plugin knows, then call finish(): what nobody asked for is an error. Every function
/// throws SceneError, at the value, for a value of the wrong form.
class Properties {
  public:
    /// Throws SceneError for a property given twice or an element that cannot stand here.
    Properties(LoadContext& context, const XmlNode& node);

    [[nodiscard]] const XmlNode& node() const { return node_; }
    [[nodiscard]] bool has(std::string_view name) const;

    /// A finite number within float's range (<float> or <integer>).
    [[nodiscard]] double number(std::string_view name, double fallback);
    /// A number > 0.
    [[nodiscard]] double positive(std::string_view name, double fallback);
    [[nodiscard]] std::int64_t integer(std::string_view name, std::int64_t fallback,
                                       std::int64_t lowest, std::int64_t highest);
    [[nodiscard]] bool boolean(std::string_view name, bool fallback);
    /// The attribute that holds a string; null if the property is absent.
    [[nodiscard]] const XmlAttribute* string(std::string_view name);
    /// Index of the value among `names`, without regard to letter case.
    [[nodiscard]] std::size_t choice(std::string_view name, std::size_t fallback,
                                     std::initializer_list<std::string_view> names);
    /// <point> or <vector>.
    [[nodiscard]] Vec3 point(std::string_view name, Vec3 fallback);
    /// A colour in [lowest, highest]; outside: an error, or clamped and reported if lenient.
    [[nodiscard]] Rgb colour(std::string_view name, Rgb fallback, float lowest, float highest);
    /// Invertible and affine; the identity if absent.
    [[nodiscard]] Transform transform(std::string_view name);

    /// Nested objects of this element name, and references to such, in the order of the file.
    /// References come as the element that they mean.
    [[nodiscard]] std::vector<const XmlNode*> objects(std::string_view element);

    /// Properties that other renderers' scenes carry and that change no pixel: to the import
    /// report.
    void changes_no_pixel(std::initializer_list<std::string_view> names);
    /// Properties that are known but not supported: an error, or to the report if lenient.
    void not_supported(std::initializer_list<std::string_view> names);
    /// Everything not asked for so far goes to the report: the plugin stands in for another one.
    void ignore_rest();
    /// Throws SceneError for the first property or object that nobody asked for.
    void finish();

    /// Throws SceneError at the value of a property: `bad value of 'name' (got 'X', expected Y)`.
    [[noreturn]] void refuse(std::string_view name, const std::string& expected) const;

  private:
    struct Entry {
        std::string name;       ///< in snake_case; empty for objects without a name
        const XmlNode* element; ///< the child
        const XmlNode* object;  ///< what a reference means, else the child
        bool used = false;
    };
    Entry make_entry(const XmlNode& child) const;
    const Entry* peek(std::string_view name) const;
    /// The property, marked as used; null if absent. Throws if its element is none of `elements`.
    const XmlNode* take(std::string_view name, std::initializer_list<std::string_view> elements);
    const XmlNode* entry_element(std::string_view name);
    [[nodiscard]] std::string title() const;
    Rgb unsupported_colour(const Entry& entry, Rgb fallback);

    LoadContext& context_;
    const XmlNode& node_;
    std::vector<Entry> entries_;
    std::vector<std::string_view> known_; ///< names asked for: candidates for "did you mean"
};

} // namespace plumb
