#include "renderer/sampling/film_filter.h"

#include <array>
#include <cmath>

namespace plumb {
namespace {

/// Mitchell & Netravali 1988, eq. 8, at a distance of x pixels.
double mitchell(double x, double b, double c) {
    x = std::fabs(x);
    if (x < 1)
        return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b)) /
               6;
    if (x < 2)
        return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x +
                (8 * b + 24 * c)) /
               6;
    return 0;
}

double radius_of(const Filter& f) {
    switch (f.kind) {
    case FilterKind::box: return 0.5;
    case FilterKind::tent: return static_cast<double>(f.radius);
    case FilterKind::gaussian: return 4 * static_cast<double>(f.stddev);
    case FilterKind::mitchell: return 2;
    }
    return 0.5;
}

double value_of(const Filter& f, double x, double radius) {
    switch (f.kind) {
    case FilterKind::box: return 1;
    case FilterKind::tent: return 1 - std::fabs(x) / radius;
    case FilterKind::gaussian: {
        const double s = static_cast<double>(f.stddev);
        return std::exp(-0.5 * x * x / (s * s)) - std::exp(-0.5 * radius * radius / (s * s));
    }
    case FilterKind::mitchell:
        return mitchell(x, static_cast<double>(f.b), static_cast<double>(f.c));
    }
    return 0;
}

} // namespace

FilterTable make_filter_table(const Filter& filter) {
    constexpr int n = FilterTable::cells;
    constexpr int steps = 16; // midpoint rule inside a cell
    const double radius = radius_of(filter);
    std::array<double, n> integral{};
    double total = 0, absolute = 0;
    for (int i = 0; i < n; ++i) {
        for (int k = 0; k < steps; ++k) {
            const double x = radius * (2 * (i + (k + 0.5) / steps) / n - 1);
            integral[static_cast<std::size_t>(i)] += value_of(filter, x, radius);
        }
        total += integral[static_cast<std::size_t>(i)];
        absolute += std::fabs(integral[static_cast<std::size_t>(i)]);
    }
    FilterTable table;
    table.kind = filter.kind;
    table.radius = static_cast<float>(radius);
    double sum = 0;
    for (int i = 0; i < n; ++i) {
        const double cell = integral[static_cast<std::size_t>(i)];
        table.cdf[i] = static_cast<float>(sum / absolute);
        table.sign[i] = static_cast<float>(std::copysign(absolute / total, cell));
        sum += std::fabs(cell);
    }
    table.cdf[n] = 1;
    return table;
}

} // namespace plumb
