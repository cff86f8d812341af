/// \file  Four floats in one register, and a box in two: what the builders compute with. Host only.
///
/// + - * round as their scalar counterparts do, so the answers do not depend on the instruction
/// set. The fourth lane of a box is zero (loads mask it): it never meets a denormal or a NaN.
#pragma once

#include "accel/math/bounds.h"

#include <cstdint>
#include <limits>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace plumb::float4 {

#ifdef __SSE2__

using Float4 = __m128;
inline Float4 broadcast(float x) { return _mm_set1_ps(x); }
inline Float4 set(float x, float y, float z) { return _mm_setr_ps(x, y, z, 0); }
/// The first three of four floats at an address divisible by 16; the fourth is read and ignored.
inline Float4 load_xyz(const float* p) {
    const __m128i mask = _mm_setr_epi32(-1, -1, -1, 0);
    return _mm_and_ps(_mm_load_ps(p), _mm_castsi128_ps(mask));
}
/// Writes three floats to an address divisible by 16, and what it likes to the fourth.
inline void store(float* p, Float4 x) { _mm_store_ps(p, x); }
/// A Vec3: reads 12 bytes, wherever they are.
inline Float4 load(const Vec3& v) {
    const __m128 xy = _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i_u*>(&v.x)));
    return _mm_movelh_ps(xy, _mm_load_ss(&v.z));
}
inline Float4 add(Float4 a, Float4 b) { return _mm_add_ps(a, b); }
inline Float4 subtract(Float4 a, Float4 b) { return _mm_sub_ps(a, b); }
inline Float4 multiply(Float4 a, Float4 b) { return _mm_mul_ps(a, b); }
inline Float4 divide(Float4 a, Float4 b) { return _mm_div_ps(a, b); }
/// a < b ? a : b
inline Float4 min(Float4 a, Float4 b) { return _mm_min_ps(a, b); }
/// a > b ? a : b
inline Float4 max(Float4 a, Float4 b) { return _mm_max_ps(a, b); }
inline Float4 abs(Float4 a) { return _mm_andnot_ps(_mm_set1_ps(-0.0f), a); }
/// {y, z, x}
inline Float4 rotate(Float4 a) { return _mm_shuffle_ps(a, a, _MM_SHUFFLE(3, 0, 2, 1)); }
inline float first(Float4 a) { return _mm_cvtss_f32(a); }
/// Bit i: whether a < b in lane i.
inline unsigned less(Float4 a, Float4 b) {
    return static_cast<unsigned>(_mm_movemask_ps(_mm_cmplt_ps(a, b)));
}
/// The point where `bit` is 1; where it is 0 a NaN, which min(x, b) and max(x, b) answer with b.
inline Float4 only_if(unsigned bit, Float4 point) {
    const __m128i none = _mm_set1_epi32(static_cast<int>(bit) - 1);
    return _mm_or_ps(point, _mm_castsi128_ps(none));
}
/// Each lane without its fraction; below 2^31.
inline void truncate(Float4 a, std::int32_t (&out)[4]) {
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out), _mm_cvttps_epi32(a));
}

#else

struct Float4 {
    float lane[4];
};
template <class Operation> inline Float4 each(Float4 a, Float4 b, Operation operation) {
    Float4 result{};
    for (int i = 0; i < 4; ++i)
        result.lane[i] = operation(a.lane[i], b.lane[i]);
    return result;
}
inline Float4 broadcast(float x) { return {{x, x, x, x}}; }
inline Float4 set(float x, float y, float z) { return {{x, y, z, 0}}; }
inline Float4 load_xyz(const float* p) { return {{p[0], p[1], p[2], 0}}; }
inline void store(float* p, Float4 x) {
    for (int i = 0; i < 3; ++i)
        p[i] = x.lane[i];
}
inline Float4 load(const Vec3& v) { return set(v.x, v.y, v.z); }
inline Float4 add(Float4 a, Float4 b) {
    return each(a, b, [](float x, float y) { return x + y; });
}
inline Float4 subtract(Float4 a, Float4 b) {
    return each(a, b, [](float x, float y) { return x - y; });
}
inline Float4 multiply(Float4 a, Float4 b) {
    return each(a, b, [](float x, float y) { return x * y; });
}
inline Float4 divide(Float4 a, Float4 b) {
    return each(a, b, [](float x, float y) { return x / y; });
}
inline Float4 min(Float4 a, Float4 b) {
    return each(a, b, [](float x, float y) { return x < y ? x : y; });
}
inline Float4 max(Float4 a, Float4 b) {
    return each(a, b, [](float x, float y) { return x > y ? x : y; });
}
inline Float4 abs(Float4 a) {
    return each(a, a, [](float x, float) { return std::fabs(x); });
}
inline Float4 rotate(Float4 a) { return {{a.lane[1], a.lane[2], a.lane[0], a.lane[3]}}; }
inline float first(Float4 a) { return a.lane[0]; }
inline unsigned less(Float4 a, Float4 b) {
    unsigned mask = 0;
    for (unsigned i = 0; i < 4; ++i)
        mask |= (a.lane[i] < b.lane[i] ? 1u : 0u) << i;
    return mask;
}
inline Float4 only_if(unsigned bit, Float4 point) {
    return bit != 0 ? point : broadcast(std::numeric_limits<float>::quiet_NaN());
}
inline void truncate(Float4 a, std::int32_t (&out)[4]) {
    for (int i = 0; i < 4; ++i)
        out[i] = static_cast<std::int32_t>(a.lane[i]);
}

#endif

/// A box; empty until it is extended.
struct Box {
    Float4 lower = set(infinity, infinity, infinity);
    Float4 upper = set(-infinity, -infinity, -infinity);

    void extend(const Box& other) {
        lower = min(lower, other.lower);
        upper = max(upper, other.upper);
    }
    /// Ignores a NaN.
    void extend_point(Float4 point) {
        lower = min(point, lower);
        upper = max(point, upper);
    }
    [[nodiscard]] bool is_empty() const { return (less(upper, lower) & 7u) != 0; }
    [[nodiscard]] Float4 extent() const { return subtract(upper, lower); }
    /// Half the surface area after scaling by `scale`; not for empty boxes.
    [[nodiscard]] float half_area(Float4 scale) const {
        const Float4 d = multiply(extent(), scale);
        const Float4 p = multiply(d, rotate(d));
        const Float4 yz = rotate(p);
        return first(add(add(p, yz), rotate(yz)));
    }
    [[nodiscard]] Bounds bounds() const {
        alignas(16) float l[4], u[4];
        store(l, lower);
        store(u, upper);
        return {{l[0], l[1], l[2]}, {u[0], u[1], u[2]}};
    }
};

} // namespace plumb::float4
