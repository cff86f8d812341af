/// \file  Eight floats in one register: AVX2 and FMA3. For avx2.cpp and avx512.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <immintrin.h>

namespace plumb {
namespace {

/// For each mask the numbers of the lanes whose bits are set, a byte each, lowest first.
inline constexpr auto packing = [] {
    std::array<std::uint64_t, 256> table{};
    for (unsigned mask = 0; mask < 256; ++mask)
        for (unsigned lane = 0, count = 0; lane < 8; ++lane)
            if ((mask >> lane & 1u) != 0)
                table[mask] |= std::uint64_t{lane} << (8 * count++);
    return table;
}();

struct Lanes {
    using Floats = __m256;

    static Floats load(const float* p) { return _mm256_load_ps(p); }
    static void store(float* p, Floats x) { _mm256_store_ps(p, x); }
    static Floats broadcast(float x) { return _mm256_set1_ps(x); }
    static Floats multiply_add(Floats a, Floats b, Floats c) { return _mm256_fmadd_ps(a, b, c); }
    /// a < b ? a : b: b where either is NaN.
    static Floats min(Floats a, Floats b) { return _mm256_min_ps(a, b); }
    /// a > b ? a : b: b where either is NaN.
    static Floats max(Floats a, Floats b) { return _mm256_max_ps(a, b); }
    static Floats absolute(Floats x) { return _mm256_andnot_ps(broadcast(-0.0f), x); }
    static Floats exclusive_or(Floats a, Floats b) { return _mm256_xor_ps(a, b); }
    // Masks: all bits of a lane set or none; comparisons are false where either is NaN.
    static Floats equal(Floats a, Floats b) { return _mm256_cmp_ps(a, b, _CMP_EQ_OQ); }
    static Floats less(Floats a, Floats b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
    static Floats not_greater(Floats a, Floats b) { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
    static Floats both(Floats a, Floats b) { return _mm256_and_ps(a, b); }
    static Floats either(Floats a, Floats b) { return _mm256_or_ps(a, b); }
    /// One bit a lane: its sign, or that it is in a mask.
    static unsigned bits(Floats x) { return static_cast<unsigned>(_mm256_movemask_ps(x)); }
    /// The lane of a number that is there.
    static unsigned find(const std::uint32_t* in, std::uint32_t number) {
        const __m256i all = _mm256_load_si256(reinterpret_cast<const __m256i*>(in));
        const __m256i same = _mm256_cmpeq_epi32(all, _mm256_set1_epi32(static_cast<int>(number)));
        return static_cast<unsigned>(
            __builtin_ctz(static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(same)))));
    }
    /// Writes the numbers whose bit is set, in order, and anything behind them up to eight.
    static void store_packed(std::uint32_t* to, const std::uint32_t* from, unsigned mask) {
        const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
        const __m256i lanes =
            _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(packing[mask])));
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                            _mm256_permutevar8x32_epi32(all, lanes));
    }
};

/// rows[j][i] = from[i][j]: eight floats from each of eight places.
inline void transpose8(const float* const* from, __m256* rows) {
    __m256 pair[8], four[8];
    for (int i = 0; i < 8; i += 2) {
        const __m256 a = _mm256_loadu_ps(from[i]), b = _mm256_loadu_ps(from[i + 1]);
        pair[i] = _mm256_unpacklo_ps(a, b);
        pair[i + 1] = _mm256_unpackhi_ps(a, b);
    }
    for (int i = 0; i < 8; i += 4)
        for (int k = 0; k < 2; ++k) {
            four[i + 2 * k] = _mm256_shuffle_ps(pair[i + k], pair[i + 2 + k], 0b01'00'01'00);
            four[i + 2 * k + 1] = _mm256_shuffle_ps(pair[i + k], pair[i + 2 + k], 0b11'10'11'10);
        }
    for (int j = 0; j < 4; ++j) {
        rows[j] = _mm256_permute2f128_ps(four[j], four[4 + j], 0x20);
        rows[4 + j] = _mm256_permute2f128_ps(four[j], four[4 + j], 0x31);
    }
}

/// One number of eight: `choose` takes the better of two, lane by lane.
template <class Choose> inline float fold(__m256 x, Choose choose) {
    __m128 four = choose(_mm256_castps256_ps128(x), _mm256_extractf128_ps(x, 1));
    four = choose(four, _mm_movehl_ps(four, four));
    return _mm_cvtss_f32(choose(four, _mm_shuffle_ps(four, four, 1)));
}

} // namespace
} // namespace plumb
