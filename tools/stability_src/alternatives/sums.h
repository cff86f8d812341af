/// \file  Accumulators and warps that lose: oracles of failure, for tools/stability and its tests
/// only.
#pragma once

#include "accel/math/vec.h"

namespace plumb::stability {

/// Plain float.
struct FloatSum {
    float sum = 0;
    void add(float x) { sum += x; }
};

/// W. Kahan, "Further Remarks on Reducing Truncation Errors", CACM 8(1), 1965, in float: the sum is
/// as good as a float can be, which is not enough for a film.
struct KahanSum {
    float sum = 0, lost = 0;
    void add(float x) {
        const float y = x - lost, t = sum + y;
        lost = (t - sum) - y;
        sum = t;
    }
};

/// Variance as E[x^2] - E[x]^2 with sums of type T.
template <class T> struct MomentVariance {
    T sum = 0, squares = 0, n = 0;
    void add(float x) {
        const T y = static_cast<T>(x);
        sum += y;
        squares += y * y;
        n += 1;
    }
    [[nodiscard]] double variance() const {
        const T mean = sum / n;
        return static_cast<double>(squares / n - mean * mean);
    }
};

/// Barycentrics by folding nothing and rooting nothing: u.x is taken as the distance from the first
/// vertex, so points crowd there.
inline Vec2 sample_triangle_without_root(Vec2 u) { return {u.x * (1 - u.y), u.x * u.y}; }

/// An 8-bit code of a value of 0 .. 1 without rounding: half a code too dark.
inline int truncated_code(float value) { return static_cast<int>(255 * value); }

/// 1 - cos of a cone's half angle as it stands, in float.
inline float one_minus_cos_direct(float sin2) { return 1 - std::sqrt(max(0.0f, 1 - sin2)); }

} // namespace plumb::stability
