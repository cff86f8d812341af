/// \file  Eight floats in one register: AVX2 and FMA3. For avx2.cpp and avx512.cpp.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <immintrin.h>

namespace plumb {
namespace {

/// For each mask the numbers of the lanes whose bits are set, a byte each, lowest first; then one
/// of a lane whose bit is not.
inline constexpr auto packing = [] {
    std::array<std::uint64_t, 256> table{};
    for (unsigned mask = 0; mask < 256; ++mask) {
        unsigned count = 0;
        for (unsigned lane = 0; lane < 8; ++lane)
            if ((mask >> lane & 1u) != 0)
                table[mask] |= std::uint64_t{lane} << (8 * count++);
        for (; count < 8; ++count)
            table[mask] |= static_cast<std::uint64_t>(std::countr_one(mask)) << (8 * count);
    }
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
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                            _mm256_permutevar8x32_epi32(all, packed_lanes(mask)));
    }
    /// Writes stack entries (enter_children.h) of the children in the mask `entered`, farthest
    /// first, and returns how many; what follows up to eight may be overwritten. Sorted by the
    /// distance less its last three bits, which hold the lane meanwhile: four without a jump.
    static int push_sorted(std::uint64_t* to, Floats near, Floats entered,
                           const std::uint32_t* child) {
        const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
        const __m256i distance =
            _mm256_andnot_si256(_mm256_set1_epi32(lane_bits), _mm256_castps_si256(near));
        const __m256i keys = _mm256_and_si256(_mm256_or_si256(distance, lane),
                                              _mm256_castps_si256(entered)); // others last
        const __m256i refs = _mm256_load_si256(reinterpret_cast<const __m256i*>(child));
        const unsigned mask = bits(entered);
        const int count = std::popcount(mask);
        __m256i packed = _mm256_permutevar8x32_epi32(keys, packed_lanes(mask));
        if (count > 4) [[unlikely]] {
            packed = sort_eight(packed, count);
            store_entries(to + 4, _mm256_extracti128_si256(packed, 1), refs);
        } else {
            packed = _mm256_castsi128_si256(sort_four(_mm256_castsi256_si128(packed)));
        }
        store_entries(to, _mm256_castsi256_si128(packed), refs);
        return count;
    }

    static constexpr std::uint32_t lane_bits = 7;
    /// Keys of the lanes whose bit is set (LeafQueues): distances, which are not negative, with
    /// the lane in their last bits. The key of others is a NaN.
    static void store_keys(std::uint32_t* to, Floats near, unsigned mask) {
        const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
        const __m256i bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
        const __m256i out =
            _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(static_cast<int>(mask)), bit),
                               _mm256_setzero_si256());
        const __m256i distance =
            _mm256_andnot_si256(_mm256_set1_epi32(lane_bits), _mm256_castps_si256(near));
        _mm256_store_si256(reinterpret_cast<__m256i*>(to),
                           _mm256_or_si256(_mm256_or_si256(distance, lane), out));
    }
    /// The least key, in whose place a NaN above all others is left.
    static std::uint32_t take_least(std::uint32_t* keys) {
        const __m256i all = _mm256_load_si256(reinterpret_cast<const __m256i*>(keys));
        __m256i least = _mm256_min_epu32(all, _mm256_permute2x128_si256(all, all, 1));
        least = _mm256_min_epu32(least, _mm256_shuffle_epi32(least, 0b01'00'11'10));
        least = _mm256_min_epu32(least, _mm256_shuffle_epi32(least, 0b10'11'00'01));
        _mm256_store_si256(reinterpret_cast<__m256i*>(keys),
                           _mm256_or_si256(all, _mm256_cmpeq_epi32(all, least)));
        return static_cast<std::uint32_t>(_mm256_cvtsi256_si32(least));
    }

  private:
    static __m256i packed_lanes(unsigned mask) {
        return _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(packing[mask])));
    }
    /// Descending.
    static __m128i sort_four(__m128i x) {
        __m128i other = _mm_shuffle_epi32(x, 0b10'11'00'01);
        x = _mm_blend_epi32(_mm_max_epu32(x, other), _mm_min_epu32(x, other), 0b1010);
        other = _mm_shuffle_epi32(x, 0b01'00'11'10);
        x = _mm_blend_epi32(_mm_max_epu32(x, other), _mm_min_epu32(x, other), 0b1100);
        other = _mm_shuffle_epi32(x, 0b11'01'10'00);
        return _mm_blend_epi32(_mm_max_epu32(x, other), _mm_min_epu32(x, other), 0b0100);
    }
    /// Descending, the first `count`.
    static __m256i sort_eight(__m256i x, int count) {
        alignas(32) std::uint32_t key[8];
        _mm256_store_si256(reinterpret_cast<__m256i*>(key), x);
        for (int i = 1; i < count; ++i) {
            const std::uint32_t one = key[i];
            int j = i;
            for (; j > 0 && key[j - 1] < one; --j)
                key[j] = key[j - 1];
            key[j] = one;
        }
        return _mm256_load_si256(reinterpret_cast<const __m256i*>(key));
    }
    static void store_entries(std::uint64_t* to, __m128i keys, __m256i refs) {
        const __m128i near = _mm_andnot_si128(_mm_set1_epi32(lane_bits), keys);
        const __m128i ref =
            _mm256_castsi256_si128(_mm256_permutevar8x32_epi32(refs, _mm256_castsi128_si256(keys)));
        auto* out = reinterpret_cast<__m128i*>(to);
        _mm_storeu_si128(out, _mm_unpacklo_epi32(ref, near));
        _mm_storeu_si128(out + 1, _mm_unpackhi_epi32(ref, near));
    }
};

/// rows[j][i] = from(i)[j]: eight floats from each of eight places.
template <class From> inline void transpose8(From&& from, __m256 (&rows)[8]) {
    __m256 pair[8], four[8];
    for (int i = 0; i < 8; i += 2) {
        const __m256 a = _mm256_loadu_ps(from(i)), b = _mm256_loadu_ps(from(i + 1));
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

/// The least number of each of eight registers.
inline __m256 smallest_of(const __m256* rows) {
    const auto pair = [&](int i) {
        return _mm256_min_ps(_mm256_unpacklo_ps(rows[i], rows[i + 1]),
                             _mm256_unpackhi_ps(rows[i], rows[i + 1]));
    };
    const auto four = [&](int i) {
        const __m256 a = pair(i), b = pair(i + 2);
        return _mm256_min_ps(_mm256_shuffle_ps(a, b, 0b01'00'01'00),
                             _mm256_shuffle_ps(a, b, 0b11'10'11'10));
    };
    const __m256 low = four(0), high = four(4);
    return _mm256_min_ps(_mm256_permute2f128_ps(low, high, 0x20),
                         _mm256_permute2f128_ps(low, high, 0x31));
}

/// One number of eight: `choose` takes the better of two, lane by lane.
template <class Choose> inline float fold(__m256 x, Choose choose) {
    __m128 four = choose(_mm256_castps256_ps128(x), _mm256_extractf128_ps(x, 1));
    four = choose(four, _mm_movehl_ps(four, four));
    return _mm_cvtss_f32(choose(four, _mm_shuffle_ps(four, four, 1)));
}

} // namespace
} // namespace plumb
