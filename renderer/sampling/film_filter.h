/// \file  Importance sampling of the reconstruction filter, host and device.
///
/// A sample belongs to one pixel: its position is drawn from |filter| around the pixel's centre, so
/// that the mean of a pixel's samples, times the weights, is the filtered image (Ernst, Stamminger,
/// Greiner 2006).
#pragma once

#include "accel/math/vec.h"
#include "renderer/scene/filter.h"

namespace plumb {

/// One axis of a filter as a table of cells of equal width with a constant density in each.
struct FilterTable {
    static constexpr int cells = 256;

    FilterKind kind = FilterKind::box;
    float radius = 0.5f;
    float cdf[cells + 1] = {}; ///< of |filter|, from 0 to 1
    float sign[cells] = {};    ///< sign times integral(|filter|) / integral(filter)
};

struct FilterSample {
    float offset; ///< from the pixel's centre, pixels
    float weight; ///< mean 1
};

RT_HD inline FilterSample sample_filter(const FilterTable& table, float u) {
    if (table.kind == FilterKind::box)
        return {u - 0.5f, 1};
    if (table.kind == FilterKind::tent) {
        const float r = table.radius;
        return {u < 0.5f ? r * (std::sqrt(2 * u) - 1) : r * (1 - std::sqrt(2 * (1 - u))), 1};
    }
    static_assert(FilterTable::cells == 256);
    int low = 0; // eight steps of a binary search, written out: no loop within loops over samples
    const auto advance = [&](int step) { low += table.cdf[low + step] <= u ? step : 0; };
    advance(128), advance(64), advance(32), advance(16);
    advance(8), advance(4), advance(2), advance(1);
    const float share = (u - table.cdf[low]) / (table.cdf[low + 1] - table.cdf[low]);
    const float cell = (static_cast<float>(low) + share) / static_cast<float>(FilterTable::cells);
    return {table.radius * (2 * cell - 1), table.sign[low]};
}

/// Tabulates a filter; host only.
[[nodiscard]] FilterTable make_filter_table(const Filter& filter);

} // namespace plumb
