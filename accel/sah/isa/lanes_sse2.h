/// \file  Eight floats in two registers of four: SSE2, which every x86-64 has. For portable.cpp.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <emmintrin.h>

namespace plumb {
namespace {

struct Lanes {
    struct Floats {
        __m128 low, high;

        friend Floats operator+(Floats a, Floats b) {
            return {_mm_add_ps(a.low, b.low), _mm_add_ps(a.high, b.high)};
        }
        friend Floats operator-(Floats a, Floats b) {
            return {_mm_sub_ps(a.low, b.low), _mm_sub_ps(a.high, b.high)};
        }
        friend Floats operator*(Floats a, Floats b) {
            return {_mm_mul_ps(a.low, b.low), _mm_mul_ps(a.high, b.high)};
        }
        friend Floats operator/(Floats a, Floats b) {
            return {_mm_div_ps(a.low, b.low), _mm_div_ps(a.high, b.high)};
        }
    };

    static Floats load(const float* p) { return {_mm_load_ps(p), _mm_load_ps(p + 4)}; }
    static void store(float* p, Floats x) {
        _mm_store_ps(p, x.low);
        _mm_store_ps(p + 4, x.high);
    }
    static Floats broadcast(float x) { return {_mm_set1_ps(x), _mm_set1_ps(x)}; }
    /// Rounds twice, which the margins of WideRay allow for.
    static Floats multiply_add(Floats a, Floats b, Floats c) { return a * b + c; }
    /// a < b ? a : b: b where either is NaN.
    static Floats min(Floats a, Floats b) {
        return {_mm_min_ps(a.low, b.low), _mm_min_ps(a.high, b.high)};
    }
    /// a > b ? a : b: b where either is NaN.
    static Floats max(Floats a, Floats b) {
        return {_mm_max_ps(a.low, b.low), _mm_max_ps(a.high, b.high)};
    }
    static Floats absolute(Floats x) {
        const __m128 sign = _mm_set1_ps(-0.0f);
        return {_mm_andnot_ps(sign, x.low), _mm_andnot_ps(sign, x.high)};
    }
    static Floats exclusive_or(Floats a, Floats b) {
        return {_mm_xor_ps(a.low, b.low), _mm_xor_ps(a.high, b.high)};
    }
    // Masks: all bits of a lane set or none; comparisons are false where either is NaN.
    static Floats equal(Floats a, Floats b) {
        return {_mm_cmpeq_ps(a.low, b.low), _mm_cmpeq_ps(a.high, b.high)};
    }
    static Floats less(Floats a, Floats b) {
        return {_mm_cmplt_ps(a.low, b.low), _mm_cmplt_ps(a.high, b.high)};
    }
    static Floats not_greater(Floats a, Floats b) {
        return {_mm_cmple_ps(a.low, b.low), _mm_cmple_ps(a.high, b.high)};
    }
    static Floats both(Floats a, Floats b) {
        return {_mm_and_ps(a.low, b.low), _mm_and_ps(a.high, b.high)};
    }
    static Floats either(Floats a, Floats b) {
        return {_mm_or_ps(a.low, b.low), _mm_or_ps(a.high, b.high)};
    }
    /// One bit a lane: its sign, or that it is in a mask.
    static unsigned bits(Floats x) {
        return static_cast<unsigned>(_mm_movemask_ps(x.low) | _mm_movemask_ps(x.high) << 4);
    }
    /// The lane of a number that is there.
    static unsigned find(const std::uint32_t* in, std::uint32_t number) {
        unsigned lane = 0;
        while (in[lane] != number)
            ++lane;
        return lane;
    }
    /// Writes the numbers whose bit is set, in order.
    static void store_packed(std::uint32_t* to, const std::uint32_t* from, unsigned mask) {
        for (; mask != 0; mask &= mask - 1)
            *to++ = from[std::countr_zero(mask)];
    }
    /// Writes stack entries (enter_children.h) of the children in the mask `entered`, farthest
    /// first, and returns how many.
    static int push_sorted(std::uint64_t* to, Floats near, Floats entered,
                           const std::uint32_t* child) {
        alignas(16) std::uint32_t distance[8];
        _mm_store_si128(reinterpret_cast<__m128i*>(distance), _mm_castps_si128(near.low));
        _mm_store_si128(reinterpret_cast<__m128i*>(distance + 4), _mm_castps_si128(near.high));
        int count = 0;
        for (unsigned mask = bits(entered); mask != 0; mask &= mask - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(mask));
            const std::uint64_t entry = std::uint64_t{distance[lane]} << 32 | child[lane];
            int i = count++;
            for (; i > 0 && to[i - 1] < entry; --i)
                to[i] = to[i - 1];
            to[i] = entry;
        }
        return count;
    }
};

} // namespace
} // namespace plumb
