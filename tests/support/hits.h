/// \file  Comparing hits, and the instruction sets to compare.
#pragma once

#include "accel/intersector.h"

#include <bit>
#include <stdexcept>
#include <vector>

namespace plumb::test {

inline bool same_bits(const Hit& a, const Hit& b) {
    return std::bit_cast<std::uint32_t>(a.t) == std::bit_cast<std::uint32_t>(b.t) &&
           std::bit_cast<std::uint32_t>(a.u) == std::bit_cast<std::uint32_t>(b.u) &&
           std::bit_cast<std::uint32_t>(a.v) == std::bit_cast<std::uint32_t>(b.v) &&
           a.geometry == b.geometry && a.primitive == b.primitive && a.instance == b.instance;
}

/// The instruction sets that this processor has, and `automatic`.
inline std::vector<Isa> isas_here() {
    std::vector<Isa> isas{Isa::automatic};
    for (const Isa isa : {Isa::portable, Isa::avx2, Isa::avx512}) {
        try {
            (void)make_intersector(AccelKind::sah, GeometryView{},
                                   {TriangleTest::watertight, BuildQuality::medium, isa});
            isas.push_back(isa);
        } catch (const std::runtime_error&) {
            continue; // a processor without it
        }
    }
    return isas;
}

} // namespace plumb::test
