/// \file  Two- and three-component float vectors, host and device.
///
/// Every operation is written out in one fixed order and compiled without FMA contraction, so that
/// all compilers and devices give the same bits.
#pragma once

#include "accel/math/host_device.h"

#include <cmath>
#include <cstdint>

namespace plumb {

struct Vec2 {
    float x = 0, y = 0;
};

struct Vec3 {
    float x = 0, y = 0, z = 0;

    [[nodiscard]] RT_HD constexpr float operator[](int axis) const {
        return axis == 0 ? x : axis == 1 ? y : z;
    }
    [[nodiscard]] RT_HD constexpr float& operator[](int axis) {
        return axis == 0 ? x : axis == 1 ? y : z;
    }
    constexpr bool operator==(const Vec3&) const = default;
};

RT_HD constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
RT_HD constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
RT_HD constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
RT_HD constexpr Vec3 operator*(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
RT_HD constexpr Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
RT_HD constexpr Vec3 operator*(float s, Vec3 a) { return a * s; }
RT_HD constexpr Vec3 operator/(Vec3 a, float s) { return {a.x / s, a.y / s, a.z / s}; }
RT_HD constexpr Vec3& operator+=(Vec3& a, Vec3 b) { return a = a + b; }
RT_HD constexpr Vec3& operator*=(Vec3& a, float s) { return a = a * s; }

RT_HD constexpr float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
RT_HD constexpr Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
RT_HD inline float length(Vec3 a) { return std::sqrt(dot(a, a)); }
/// Unit vector along `a`; NaN for the zero vector.
RT_HD inline Vec3 normalize(Vec3 a) { return a / length(a); }
RT_HD inline Vec3 abs(Vec3 a) { return {std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)}; }

RT_HD constexpr float min(float a, float b) { return a < b ? a : b; }
RT_HD constexpr float max(float a, float b) { return a > b ? a : b; }
RT_HD constexpr float clamp(float x, float low, float high) { return min(max(x, low), high); }
RT_HD constexpr Vec3 min(Vec3 a, Vec3 b) { return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)}; }
RT_HD constexpr Vec3 max(Vec3 a, Vec3 b) { return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)}; }
RT_HD constexpr float max_component(Vec3 a) { return max(a.x, max(a.y, a.z)); }

/// Unit vector along `a` for any length from 1e-38 to 1e38 (scaled first, so that no square over-
/// or underflows); zero for the zero vector.
RT_HD inline Vec3 safe_normalize(Vec3 a) {
    const float largest = max_component(abs(a));
    return largest > 0 ? normalize(a / largest) : Vec3{};
}

inline constexpr float pi = 3.14159265358979323846f;
inline constexpr float inv_pi = 0.31830988618379067154f;
inline constexpr float inv_two_pi = 0.15915494309189533577f;
/// Half an ulp of 1 in float: the relative error of one rounding.
inline constexpr float unit_roundoff = 0x1p-24f;
/// Larger coordinates are rejected: their products and areas would overflow (Embree's limit too).
inline constexpr float max_coordinate = 1.8e18f;

/// Bound of the relative error of n roundings in a row (Higham 2002, lemma 3.1).
RT_HD constexpr float rounding_bound(int n) {
    const float nu = static_cast<float>(n) * unit_roundoff;
    return nu / (1 - nu);
}

RT_HD inline bool is_finite(Vec3 a) {
    const bool x = std::fabs(a.x) <= max_coordinate, y = std::fabs(a.y) <= max_coordinate,
               z = std::fabs(a.z) <= max_coordinate;
    return x & y & z;
}

} // namespace plumb
