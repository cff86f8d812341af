#include "tools/compare_picture.h"

#include <algorithm>
#include <cmath>

namespace plumb {
namespace {

/// The channel with the largest absolute value, with its sign; NaN if any is.
float strongest(Rgb c) {
    float result = c.r;
    for (const float value : {c.g, c.b})
        if (std::isnan(value) || std::abs(value) > std::abs(result))
            result = value;
    return result;
}

float percentile_99(const std::vector<float>& values) {
    std::vector<float> magnitudes;
    for (const float value : values)
        if (std::isfinite(value))
            magnitudes.push_back(std::abs(value));
    if (magnitudes.empty())
        return 1;
    const auto rank = static_cast<std::ptrdiff_t>((magnitudes.size() - 1) * 99 / 100);
    std::nth_element(magnitudes.begin(), magnitudes.begin() + rank, magnitudes.end());
    const float found = magnitudes[static_cast<std::size_t>(rank)];
    return found > 0 ? found : 1;
}

Rgb colour_of(float difference, float scale) {
    if (!std::isfinite(difference))
        return {0, 1, 0};
    const float shown = std::abs(difference) / scale;
    return difference > 0 ? Rgb{shown, 0, 0} : Rgb{0, 0, shown};
}

} // namespace

Image signed_difference(const Image& a, const Image& b) {
    Image difference = a;
    difference.variance.clear();
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        difference.pixels[i] = a.pixels[i] + b.pixels[i] * -1.0f;
    return difference;
}

Image difference_picture(const Image& a, const Image& b, std::optional<float> scale) {
    Image picture = signed_difference(a, b);
    std::vector<float> values;
    values.reserve(picture.pixels.size());
    for (const Rgb& c : picture.pixels)
        values.push_back(strongest(c));
    const float full = scale ? *scale : percentile_99(values);
    for (std::size_t i = 0; i < values.size(); ++i)
        picture.pixels[i] = colour_of(values[i], full);
    return picture;
}

} // namespace plumb
