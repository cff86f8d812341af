/// \file  The ray queries over the 8-wide tree, one table an instruction set.
#pragma once

#include "accel/intersector.h"
#include "accel/sah/wide_bvh.h"

namespace plumb {

/// All of them take any ray (invalid ones miss) and give the same bits in every table.
struct WideKernels {
    Hit (*closest)(const WideView&, const Ray&);
    bool (*occluded)(const WideView&, const Ray&);
    void (*closest_stream)(const WideView&, std::span<const Ray>, std::span<Hit>);
    void (*occluded_stream)(const WideView&, std::span<const Ray>, std::span<std::uint8_t>);
    TraversalCounts (*count)(const WideView&, std::span<const Ray>, bool any_hit);
};

[[nodiscard]] WideKernels portable_kernels(TriangleTest test); ///< SSE2, or no vectors at all
[[nodiscard]] WideKernels avx2_kernels(TriangleTest test);     ///< AVX2 and FMA3
[[nodiscard]] WideKernels avx512_kernels(TriangleTest test);   ///< AVX-512 F, VL, BW and DQ

/// The best instruction set that this processor has, or the one asked for. Throws
/// std::runtime_error where the processor lacks it.
[[nodiscard]] Isa usable_isa(Isa wanted);
[[nodiscard]] WideKernels kernels_for(Isa usable, TriangleTest test);

} // namespace plumb
