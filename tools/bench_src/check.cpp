#include "tools/bench_src/check.h"

#include <bit>
#include <cmath>
#include <cstdlib>

namespace plumb::bench {
namespace {

bool same_bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

bool same(const Hit& a, const Hit& b) {
    return same_bits(a.t, b.t) && same_bits(a.u, b.u) && same_bits(a.v, b.v) &&
           a.geometry == b.geometry && a.primitive == b.primitive && a.instance == b.instance;
}

/// Of two positive floats.
bool near(float a, float b) {
    const std::int64_t ulps =
        std::int64_t{std::bit_cast<std::int32_t>(a)} - std::int64_t{std::bit_cast<std::int32_t>(b)};
    return std::abs(ulps) <= 8 || std::fabs(a - b) <= 1e-5f * std::fabs(b);
}

} // namespace

std::uint64_t different_bits(std::span<const Hit> hits, std::span<const Hit> reference) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < hits.size(); ++i)
        count += same(hits[i], reference[i]) ? 0u : 1u;
    return count;
}

std::uint64_t far_apart(std::span<const Hit> hits, std::span<const Hit> reference) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const bool agree = hits[i].valid() == reference[i].valid() &&
                           (!hits[i].valid() || near(hits[i].t, reference[i].t));
        count += agree ? 0u : 1u;
    }
    return count;
}

} // namespace plumb::bench
