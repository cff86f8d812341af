/// \file  The kernels for any processor: SSE2 where that is given, else one box and one triangle at
/// a time.
#ifdef __SSE2__
#include "accel/sah/isa/lanes_sse2.h"
#include "accel/sah/isa/make_kernels.h"
#else
#include "accel/sah/isa/kernels.h"
#include "accel/sah/wide_careful.h"
#endif

namespace plumb {

#ifdef __SSE2__

WideKernels portable_kernels(TriangleTest test) { return make_kernels<Lanes, NoPackets>(test); }

#else

namespace {

template <TriangleTest Test> WideKernels careful_kernels() {
    return {[](const WideView& tree, const Ray& ray) { return closest_careful(tree, ray, Test); },
            [](const WideView& tree, const Ray& ray) { return occluded_careful(tree, ray, Test); },
            [](const WideView& tree, std::span<const Ray> rays, std::span<Hit> hits) {
                for (std::size_t i = 0; i < rays.size(); ++i)
                    hits[i] = closest_careful(tree, rays[i], Test);
            },
            [](const WideView& tree, std::span<const Ray> rays, std::span<std::uint8_t> found) {
                for (std::size_t i = 0; i < rays.size(); ++i)
                    found[i] = occluded_careful(tree, rays[i], Test) ? 1 : 0;
            },
            [](const WideView&, std::span<const Ray>, bool) { return TraversalCounts{}; }};
}

} // namespace

WideKernels portable_kernels(TriangleTest test) {
    return test == TriangleTest::moeller_trumbore
               ? careful_kernels<TriangleTest::moeller_trumbore>()
               : careful_kernels<TriangleTest::watertight>();
}

#endif

} // namespace plumb
