/// \file  Rays at the edges, vertices and faces of a mesh, and the ways to ask whether they hit it.
#pragma once

#include "tools/stability_src/axis.h"
#include "tools/stability_src/mesh.h"

#include <memory>
#include <span>

namespace plumb::stability {

/// A ray that meets the mesh in exact arithmetic, and two vertices near the place.
struct AimedRay {
    Ray ray;
    std::uint32_t a, b;
};

/// Ray from `origin` to a point; the direction is rounded, every other one is normalised.
[[nodiscard]] Ray ray_to(Random& random, Vec3 origin, Point target);
/// At a place on a shared edge, 2 % of its length or more from either end.
[[nodiscard]] AimedRay ray_to_edge(Random& random, const Mesh& mesh, Vec3 origin);
/// At a vertex exactly.
[[nodiscard]] AimedRay ray_to_vertex(Random& random, const Mesh& mesh, Vec3 origin);

/// A way to ask.
class Prober {
  public:
    Prober() = default;
    Prober(const Prober&) = delete;
    Prober& operator=(const Prober&) = delete;
    virtual ~Prober() = default;
    /// How many of the rays miss the mesh.
    [[nodiscard]] virtual std::uint64_t misses(std::span<const AimedRay> rays) const = 0;
};

struct ProbedMethod {
    Method method;
    std::function<std::unique_ptr<Prober>(const Mesh&)> prepare; ///< the mesh must outlive it
};

/// Triangle tests alone, our trees on every instruction set that the processor has, and Embree.
[[nodiscard]] std::vector<ProbedMethod> probed_methods();

} // namespace plumb::stability
