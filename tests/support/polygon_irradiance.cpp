#include "tests/support/polygon_irradiance.h"

#include <cmath>

namespace plumb::test {

std::vector<Double3> clipped_to_horizon(std::span<const Double3> polygon) {
    std::vector<Double3> result;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Double3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        if (a[2] >= 0)
            result.push_back(a);
        if ((a[2] >= 0) != (b[2] >= 0))
            result.push_back(a + (a[2] / (a[2] - b[2])) * (b - a));
    }
    return result;
}

double polygon_irradiance(std::span<const Double3> polygon) {
    const std::vector<Double3> corners = clipped_to_horizon(polygon);
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Double3 a = normalized(corners[i]);
        const Double3 b = normalized(corners[(i + 1) % corners.size()]);
        const Double3 normal = cross(a, b);
        const double sine = std::sqrt(dot(normal, normal));
        if (sine > 0)
            sum += std::atan2(sine, dot(a, b)) * normal[2] / sine;
    }
    return 0.5 * std::fabs(sum);
}

double parallel_form_factor(double x, double y) {
    const double x2 = 1 + x * x, y2 = 1 + y * y;
    const double pi = 3.14159265358979323846;
    return 2 / (pi * x * y) *
           (std::log(std::sqrt(x2 * y2 / (x2 + y * y))) +
            x * std::sqrt(y2) * std::atan(x / std::sqrt(y2)) +
            y * std::sqrt(x2) * std::atan(y / std::sqrt(x2)) - x * std::atan(x) - y * std::atan(y));
}

} // namespace plumb::test
