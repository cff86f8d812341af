/// \file  Sixteen floats in one register: AVX-512. For avx512.cpp only.
#pragma once

#include "accel/sah/isa/lanes_avx.h"

namespace plumb {
namespace {

struct PacketLanes {
    using Floats = __m512;
    using Mask = __mmask16;
    static constexpr int width = 16;

    /// rows[j] lane i = from[i][j].
    static void transpose(const float* const* from, Floats* rows) {
        __m256 low[8], high[8];
        transpose8(from, low);
        transpose8(from + 8, high);
        for (int j = 0; j < 8; ++j)
            rows[j] = _mm512_insertf32x8(_mm512_castps256_ps512(low[j]), high[j], 1);
    }
    static Floats load(const float* p) { return _mm512_load_ps(p); }
    static void store(float* p, Floats x) { _mm512_store_ps(p, x); }
    static Floats broadcast(float x) { return _mm512_set1_ps(x); }
    static Floats repeat_first(Floats x) {
        return _mm512_broadcastss_ps(_mm512_castps512_ps128(x));
    }
    static Floats multiply_add(Floats a, Floats b, Floats c) { return _mm512_fmadd_ps(a, b, c); }
    /// a < b ? a : b: b where either is NaN.
    static Floats min(Floats a, Floats b) { return _mm512_min_ps(a, b); }
    /// a > b ? a : b: b where either is NaN.
    static Floats max(Floats a, Floats b) { return _mm512_max_ps(a, b); }
    static Floats negated(Floats x) { return _mm512_xor_ps(x, broadcast(-0.0f)); }
    static Floats absolute(Floats x) { return _mm512_abs_ps(x); }
    /// The lanes whose sign bits differ.
    static Mask signs_differ(Floats a, Floats b) {
        return _mm512_movepi32_mask(_mm512_castps_si512(_mm512_xor_ps(a, b)));
    }
    // Comparisons are false where either is NaN.
    static Mask equal(Floats a, Floats b) { return _mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ); }
    static Mask less(Floats a, Floats b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
    static Mask not_greater(Floats a, Floats b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
    static unsigned bits(Mask m) { return m; }
    static Mask mask(unsigned bits) { return static_cast<Mask>(bits); }
    static void store_where(float* p, Mask m, Floats x) { _mm512_mask_store_ps(p, m, x); }
    static float largest(Floats x) {
        const Halves h(x);
        return fold(_mm256_max_ps(h.low, h.high), [](auto a, auto b) { return _mm_max_ps(a, b); });
    }
    /// to[i]: the least number of rows[i].
    static void smallest(const Floats (&rows)[8], float (&to)[8]) {
        __m256 halves[8];
        for (int i = 0; i < 8; ++i) {
            const Halves h(rows[i]);
            halves[i] = _mm256_min_ps(h.low, h.high);
        }
        _mm256_storeu_ps(to, smallest_of(halves));
    }

  private:
    struct Halves {
        __m256 low, high;
        explicit Halves(Floats x)
            : low(_mm512_maskz_extractf32x8_ps(0xff, x, 0)),
              high(_mm512_maskz_extractf32x8_ps(0xff, x, 1)) {}
    };
};

} // namespace
} // namespace plumb
