/// \file  Random numbers as a pure function of (pixel, sample, dimension, seed), host and device.
///
/// Dimensions come in groups of four. `sobol`: group 0 is the four-dimensional Sobol' sequence
/// (direction numbers of S. Joe and F. Kuo 2008), Owen-scrambled for each pixel; later groups are
/// the same four dimensions with the sample index shuffled and scrambled anew (padding: B. Burley,
/// "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020), with the Laine-Karras permutation as
/// improved by N. Vegdahl (2021). `independent`: the pcg4d hash (M. Jarzynski, M. Olano, "Hash
/// Functions for GPU Rendering", JCGT 9(3), 2020).
#pragma once

#include "accel/math/vec.h"
#include "renderer/scene/settings.h"

#include <bit>
#include <cstdint>

namespace plumb {

/// Four numbers, each uniform in [0,1) with 24 bits.
struct Sample4 {
    float x[4];
};

namespace detail {

struct Uint4 {
    std::uint32_t x[4];
};

RT_HD inline Uint4 pcg4d(Uint4 v) {
    for (std::uint32_t& c : v.x)
        c = c * 1664525u + 1013904223u;
    const auto mix = [&v] {
        v.x[0] += v.x[1] * v.x[3];
        v.x[1] += v.x[2] * v.x[0];
        v.x[2] += v.x[0] * v.x[1];
        v.x[3] += v.x[1] * v.x[2];
    };
    mix();
    for (std::uint32_t& c : v.x)
        c ^= c >> 16;
    mix();
    return v;
}

RT_HD inline std::uint32_t reverse_bits(std::uint32_t v) {
    v = ((v >> 1) & 0x55555555u) | ((v & 0x55555555u) << 1);
    v = ((v >> 2) & 0x33333333u) | ((v & 0x33333333u) << 2);
    v = ((v >> 4) & 0x0f0f0f0fu) | ((v & 0x0f0f0f0fu) << 4);
    v = ((v >> 8) & 0x00ff00ffu) | ((v & 0x00ff00ffu) << 8);
    return (v >> 16) | (v << 16);
}

/// Owen scrambling of a number whose bits are reversed: bit i changes only with the bits below it.
RT_HD inline std::uint32_t scramble_reversed(std::uint32_t v, std::uint32_t seed) {
    v ^= v * 0x3d20adeau;
    v += seed;
    v *= (seed >> 16) | 1u;
    v ^= v * 0x05526c56u;
    v ^= v * 0x53a22864u;
    return v;
}

/// Direction numbers of the first four Sobol' dimensions with their bits reversed, a row an index
/// bit. Recurrence of Bratley and Fox 1988; initial numbers from new-joe-kuo-6: degree 0; 1 {1};
/// 2 a=1 {1,3}; 3 a=1 {1,3,1}.
struct SobolRows {
    Uint4 row[32];
};

constexpr SobolRows make_sobol_rows() {
    constexpr unsigned degree[4] = {0, 1, 2, 3};
    constexpr unsigned coefficient[4] = {0, 0, 1, 1};
    constexpr unsigned initial[4][3] = {{1, 0, 0}, {1, 0, 0}, {1, 3, 0}, {1, 3, 1}};
    SobolRows rows{};
    for (unsigned d = 0; d < 4; ++d) {
        std::uint32_t m[32] = {};
        const unsigned s = degree[d];
        for (unsigned i = 0; i < 32; ++i) {
            if (s == 0)
                m[i] = 1;
            else if (i < s)
                m[i] = initial[d][i];
            else {
                m[i] = m[i - s] ^ (m[i - s] << s);
                for (unsigned k = 1; k < s; ++k)
                    if (((coefficient[d] >> (s - 1 - k)) & 1u) != 0)
                        m[i] ^= m[i - k] << k;
            }
            // Direction number m_i / 2^(i+1): bit i of m is its most significant bit.
            std::uint32_t reversed = 0;
            for (unsigned bit = 0; bit <= i; ++bit)
                reversed |= ((m[i] >> (i - bit)) & 1u) << bit;
            rows.row[i].x[d] = reversed;
        }
    }
    return rows;
}

/// The rows summed up (xor) for every value of each byte of an index: a point takes four look-ups.
struct SobolDigits {
    Uint4 sum[4][256];
};

constexpr SobolDigits make_sobol_digits() {
    const SobolRows rows = make_sobol_rows();
    SobolDigits digits{};
    for (unsigned position = 0; position < 4; ++position)
        for (unsigned value = 1; value < 256; ++value)
            for (unsigned d = 0; d < 4; ++d) {
                const auto lowest = static_cast<unsigned>(std::countr_zero(value));
                digits.sum[position][value].x[d] = digits.sum[position][value & (value - 1)].x[d] ^
                                                   rows.row[8 * position + lowest].x[d];
            }
    return digits;
}

/// Four seeds for scrambling, independent between pixels. The low bits of pcg4d are its weak ones,
/// and scrambling takes the leading bits of its numbers from them: the high bits are mixed in (as
/// the hash lowbias32 of C. Wellons, 2018, begins).
RT_HD inline Uint4 scramble_keys(std::uint32_t pixel, std::uint32_t group, std::uint32_t seed) {
    Uint4 key = pcg4d({pixel, 0x5f356495u, group, seed});
    for (std::uint32_t& c : key.x) {
        c ^= c >> 16;
        c *= 0x7feb352du;
        c ^= c >> 15;
    }
    return key;
}

} // namespace detail

/// The numbers of one sample of one pixel.
class Sampler {
  public:
    RT_HD Sampler(SamplerKind kind, std::uint64_t seed, std::uint32_t pixel, std::uint32_t sample)
        : kind_(kind), pixel_(pixel ^ (static_cast<std::uint32_t>(seed >> 32) * 0x9e3779b9u)),
          sample_(sample), seed_(static_cast<std::uint32_t>(seed)) {}

    /// Dimensions 4 group .. 4 group + 3.
    [[nodiscard]] RT_HD Sample4 group(std::uint32_t group) const {
        if (kind_ == SamplerKind::independent)
            return to_floats(detail::pcg4d({pixel_, sample_, group, seed_}));
        return sobol(group);
    }

  private:
    RT_HD static Sample4 to_floats(const detail::Uint4& bits) {
        Sample4 s;
        for (int i = 0; i < 4; ++i)
            s.x[i] = static_cast<float>(bits.x[i] >> 8) * 0x1p-24f;
        return s;
    }

    RT_HD Sample4 sobol(std::uint32_t group) const {
        const detail::Uint4 key = detail::scramble_keys(pixel_, group, seed_);
        std::uint32_t index = sample_;
        if (group > 0) {
            // Only the low 16 bits are shuffled: blocks of 65536 samples keep their order.
            const std::uint32_t seed = key.x[1] ^ (key.x[3] * 0x9e3779b9u);
            const std::uint32_t reversed = detail::reverse_bits(index << 16);
            const std::uint32_t shuffled = detail::scramble_reversed(reversed, seed);
            index = (index & 0xffff0000u) | detail::reverse_bits(shuffled << 16);
        }
        static constexpr detail::SobolDigits digits = detail::make_sobol_digits();
        detail::Uint4 bits;
        for (int d = 0; d < 4; ++d) {
            const std::uint32_t sum =
                digits.sum[0][index & 255u].x[d] ^ digits.sum[1][(index >> 8) & 255u].x[d] ^
                digits.sum[2][(index >> 16) & 255u].x[d] ^ digits.sum[3][index >> 24].x[d];
            bits.x[d] = detail::reverse_bits(detail::scramble_reversed(sum, key.x[d]));
        }
        return to_floats(bits);
    }

    SamplerKind kind_;
    std::uint32_t pixel_, sample_, seed_;
};

} // namespace plumb
