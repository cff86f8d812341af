/// \file  Sixteen floats in one register: AVX-512. For avx512.cpp only.
#pragma once

#include "accel/sah/isa/lanes_avx.h"

namespace plumb {
namespace {

struct PacketLanes {
    using Floats = __m512;
    using Mask = __mmask16;
    static constexpr int width = 16;

    /// rows[j] lane i = from(i)[j].
    template <class From> static void transpose(From&& from, Floats (&rows)[8]) {
        for (int half = 0; half < 2; ++half) {
            Floats four[4]; // of rays i, 4 + i, 8 + i, 12 + i each
            for (int i = 0; i < 4; ++i) {
                const auto at = [&](int ray) { return _mm_loadu_ps(from(ray) + 4 * half); };
                four[i] = _mm512_insertf32x4(_mm512_castps256_ps512(_mm256_insertf128_ps(
                                                 _mm256_castps128_ps256(at(i)), at(4 + i), 1)),
                                             at(8 + i), 2);
                four[i] = _mm512_insertf32x4(four[i], at(12 + i), 3);
            }
            const Floats low01 = _mm512_unpacklo_ps(four[0], four[1]);
            const Floats high01 = _mm512_unpackhi_ps(four[0], four[1]);
            const Floats low23 = _mm512_unpacklo_ps(four[2], four[3]);
            const Floats high23 = _mm512_unpackhi_ps(four[2], four[3]);
            rows[4 * half] = _mm512_shuffle_ps(low01, low23, 0b01'00'01'00);
            rows[4 * half + 1] = _mm512_shuffle_ps(low01, low23, 0b11'10'11'10);
            rows[4 * half + 2] = _mm512_shuffle_ps(high01, high23, 0b01'00'01'00);
            rows[4 * half + 3] = _mm512_shuffle_ps(high01, high23, 0b11'10'11'10);
        }
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
    static unsigned signs(Floats x) { return _mm512_movepi32_mask(_mm512_castps_si512(x)); }
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
    /// A whole store: a load after a masked one would wait.
    static void store_where(float* p, Mask m, Floats x) {
        store(p, _mm512_mask_blend_ps(m, load(p), x));
    }
    static float largest(Floats x) {
        const Halves h(x);
        return fold(_mm256_max_ps(h.low, h.high), [](auto a, auto b) { return _mm_max_ps(a, b); });
    }
    /// to[i / 4] lane i % 4: the least number of rows[i].
    static void smallest(const Floats (&rows)[16], __m128 (&to)[4]) {
        const auto pair = [&](int i) {
            return _mm512_min_ps(_mm512_unpacklo_ps(rows[i], rows[i + 1]),
                                 _mm512_unpackhi_ps(rows[i], rows[i + 1]));
        };
        const auto four = [&](int i) { // in each quarter, of its lanes
            const Floats a = pair(i), b = pair(i + 2);
            return _mm512_min_ps(_mm512_shuffle_ps(a, b, 0b01'00'01'00),
                                 _mm512_shuffle_ps(a, b, 0b11'10'11'10));
        };
        const auto eight = [&](int i) { // quarters 0 and 2 of rows i, 1 and 3 of rows i + 4
            const Floats a = four(i), b = four(i + 4);
            return _mm512_min_ps(_mm512_shuffle_f32x4(a, b, 0b01'00'01'00),
                                 _mm512_shuffle_f32x4(a, b, 0b11'10'11'10));
        };
        const Floats a = eight(0), b = eight(8);
        const Floats least = _mm512_min_ps(_mm512_shuffle_f32x4(a, b, 0b10'00'10'00),
                                           _mm512_shuffle_f32x4(a, b, 0b11'01'11'01));
        to[0] = _mm512_castps512_ps128(least);
        to[1] = _mm512_maskz_extractf32x4_ps(0xf, least, 1);
        to[2] = _mm512_maskz_extractf32x4_ps(0xf, least, 2);
        to[3] = _mm512_maskz_extractf32x4_ps(0xf, least, 3);
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
