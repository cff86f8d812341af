/// \file  A packet of eight rays in one register: AVX2 and FMA3. For avx2.cpp only.
#pragma once

#include "accel/sah/isa/lanes_avx.h"

namespace plumb {
namespace {

struct PacketLanes {
    using Floats = __m256;
    using Mask = unsigned; ///< a bit a lane
    static constexpr int width = 8;

    /// rows[j] lane i = from(i)[j].
    template <class From> static void transpose(From&& from, Floats (&rows)[8]) {
        transpose8(from, rows);
    }
    static Floats load(const float* p) { return _mm256_load_ps(p); }
    static void store(float* p, Floats x) { _mm256_store_ps(p, x); }
    static Floats broadcast(float x) { return _mm256_set1_ps(x); }
    static Floats repeat_first(Floats x) {
        return _mm256_broadcastss_ps(_mm256_castps256_ps128(x));
    }
    static Floats multiply_add(Floats a, Floats b, Floats c) { return _mm256_fmadd_ps(a, b, c); }
    static Floats min(Floats a, Floats b) { return _mm256_min_ps(a, b); }
    static Floats max(Floats a, Floats b) { return _mm256_max_ps(a, b); }
    static Floats negated(Floats x) { return _mm256_xor_ps(x, broadcast(-0.0f)); }
    static Floats absolute(Floats x) { return Lanes::absolute(x); }
    static unsigned signs(Floats x) { return Lanes::bits(x); }
    /// The lanes whose sign bits differ.
    static Mask signs_differ(Floats a, Floats b) { return Lanes::bits(_mm256_xor_ps(a, b)); }
    // Comparisons are false where either is NaN.
    static Mask equal(Floats a, Floats b) { return Lanes::bits(Lanes::equal(a, b)); }
    static Mask less(Floats a, Floats b) { return Lanes::bits(Lanes::less(a, b)); }
    static Mask not_greater(Floats a, Floats b) { return Lanes::bits(Lanes::not_greater(a, b)); }
    static unsigned bits(Mask m) { return m; }
    static Mask mask(unsigned bits) { return bits; }
    static void store_where(float* p, Mask m, Floats x) {
        const __m256i bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
        const __m256i chosen = _mm256_and_si256(_mm256_set1_epi32(static_cast<int>(m)), bit);
        _mm256_store_ps(p, _mm256_blendv_ps(_mm256_load_ps(p), x,
                                            _mm256_castsi256_ps(_mm256_cmpeq_epi32(chosen, bit))));
    }
    static float largest(Floats x) {
        return fold(x, [](auto a, auto b) { return _mm_max_ps(a, b); });
    }
    /// to[i / 4] lane i % 4: the least number of rows[i].
    static void smallest(const Floats (&rows)[16], __m128 (&to)[4]) {
        for (int half = 0; half < 2; ++half) {
            const Floats least = smallest_of(rows + 8 * half);
            to[2 * half] = _mm256_castps256_ps128(least);
            to[2 * half + 1] = _mm256_extractf128_ps(least, 1);
        }
    }
};

} // namespace
} // namespace plumb
