/// \file  Parsing of transforms.
#include "renderer/io/load_transform.h"

#include "renderer/io/colour_value.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace plumb {
namespace {

double single(const XmlNode& element, const XmlAttribute& attribute) {
    const std::vector<double> numbers = parse_doubles(element, attribute);
    if (numbers.size() != 1)
        element.refuse(attribute, fmt::format("bad value of '{}' (got '{:.40}', expected one "
                                              "number)",
                                              attribute.name, attribute.value));
    return numbers[0];
}

Transform matrix(const XmlNode& element) {
    element.allow_only({"value"});
    const XmlAttribute& value = element.require("value");
    const std::vector<double> numbers = parse_doubles(element, value);
    if (numbers.size() != 16 && numbers.size() != 9)
        element.refuse(
            value, fmt::format("bad matrix (got {} numbers, expected 16 or 9)", numbers.size()));
    const std::size_t size = numbers.size() == 16 ? 4 : 3;
    Transform transform;
    for (std::size_t row = 0; row < size; ++row)
        for (std::size_t column = 0; column < size; ++column)
            transform.m[row][column] = numbers[row * size + column];
    const auto& last = transform.m[3];
    if (last[0] != 0 || last[1] != 0 || last[2] != 0 || last[3] != 1)
        element.refuse(value, fmt::format("matrix is not affine (got last row '{} {} {} {}', "
                                          "expected '0 0 0 1')",
                                          last[0], last[1], last[2], last[3]));
    if (!transform.inverse())
        element.refuse(value, "matrix is singular (expected one with an inverse)");
    return transform;
}

Vec3 look_at_triple(const XmlNode& element, std::string_view name) {
    const XmlAttribute& attribute = element.require(name);
    const std::vector<float> v = parse_floats(element, attribute);
    if (v.size() != 3)
        element.refuse(attribute, fmt::format("bad '{}' of <{}> (got {} numbers, expected 3)", name,
                                              element.name, v.size()));
    return {v[0], v[1], v[2]};
}

Transform look_at(const XmlNode& element) {
    element.allow_only({"origin", "target", "up"});
    const Vec3 origin = look_at_triple(element, "origin");
    const Vec3 target = look_at_triple(element, "target");
    const Vec3 up = look_at_triple(element, "up");
    const auto transform = Transform::look_at(origin, target, up);
    if (transform)
        return *transform;
    if (origin == target)
        element.refuse("lookat with origin = target (expected two points)");
    element.refuse("lookat with 'up' parallel to the view, or zero (expected another direction)");
}

Transform rotate(const XmlNode& element) {
    element.allow_only({"x", "y", "z", "value", "angle"});
    const auto axis = parse_triple(element, 0);
    const double angle = single(element, element.require("angle"));
    if (!(std::hypot(axis[0], axis[1], axis[2]) > 0))
        element.refuse("rotate without an axis (expected x, y or z)");
    return Transform::rotate(axis[0], axis[1], axis[2], angle);
}

Transform scale(const XmlNode& element) {
    element.allow_only({"x", "y", "z", "value"});
    const auto s = parse_triple(element, 1);
    const Transform transform = Transform::scale(s[0], s[1], s[2]);
    if (!transform.inverse())
        element.refuse(
            fmt::format("scale without an inverse (got '{} {} {}', expected an invertible "
                        "transform)",
                        s[0], s[1], s[2]));
    return transform;
}

Transform operation(const XmlNode& element) {
    if (element.name == "translate") {
        element.allow_only({"x", "y", "z", "value"});
        const auto t = parse_triple(element, 0);
        return Transform::translate(t[0], t[1], t[2]);
    }
    if (element.name == "rotate")
        return rotate(element);
    if (element.name == "scale")
        return scale(element);
    if (element.name == "matrix")
        return matrix(element);
    if (element.name == "lookat" || element.name == "lookAt")
        return look_at(element);
    element.refuse(fmt::format("unknown operation in <transform> (got <{}>, expected translate, "
                               "rotate, scale, matrix or lookat)",
                               element.name));
}

} // namespace

std::array<double, 3> parse_triple(const XmlNode& element, double fallback) {
    std::array<double, 3> triple{fallback, fallback, fallback};
    constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
    const XmlAttribute* value = element.find("value");
    for (std::size_t i = 0; i < 3; ++i)
        if (const XmlAttribute* component = element.find(axes[i])) {
            if (value)
                element.refuse(*component, fmt::format("<{}> with both 'value' and '{}'",
                                                       element.name, axes[i]));
            triple[i] = single(element, *component);
        }
    if (!value) {
        const bool any = element.find("x") || element.find("y") || element.find("z");
        if (!any)
            element.refuse(
                fmt::format("missing attribute 'value' (or x, y, z) of <{}>", element.name));
        return triple;
    }
    const std::vector<double> numbers = parse_doubles(element, *value);
    if (numbers.size() != 1 && numbers.size() != 3)
        element.refuse(*value, fmt::format("bad value of <{}> (got {} numbers, expected 3 or 1)",
                                           element.name, numbers.size()));
    for (std::size_t i = 0; i < 3; ++i)
        triple[i] = numbers[numbers.size() == 3 ? i : 0];
    return triple;
}

Transform parse_transform(const XmlNode& element) {
    Transform product;
    for (const XmlNode& child : element.children) {
        product = operation(child) * product;
        if (!product.inverse())
            child.refuse("transform is singular or overflows (expected one with an inverse)");
    }
    return product;
}

} // namespace plumb
