/// \file  The one interface for closest-hit and any-hit queries.
#pragma once

#include "accel/geometry.h"

#include <memory>
#include <string_view>

namespace plumb {

enum class AccelKind : std::uint8_t { naive, sah, embree };

/// How much time a build may take for faster rays. sah: fast is binned SAH on the widest axis,
/// medium on all three, high adds spatial splits and reinsertion. embree: low, medium and high. naive: ignored.
enum class BuildQuality : std::uint8_t { fast, medium, high };

/// Instruction sets of the sah traversal; all give the same bits. `automatic` is the best that the
/// processor has.
enum class Isa : std::uint8_t { automatic, portable, avx2, avx512 };

struct BuildOptions {
    TriangleTest triangle_test =
        TriangleTest::watertight; ///< naive and sah; embree: watertight only
    BuildQuality quality = BuildQuality::medium;
    Isa isa = Isa::automatic; ///< sah only
    int threads = 0;          ///< of the build; 0: all cores. The tree is the same for any number
};

/// What closest-hit or any-hit queries touched, summed over rays.
struct TraversalCounts {
    std::uint64_t nodes = 0;     ///< inner nodes whose children's boxes were tested
    std::uint64_t leaves = 0;    ///< leaves tested
    std::uint64_t triangles = 0; ///< primitives in them, filled lanes only
};

struct AccelStats {
    double build_s = 0;
    std::size_t bytes = 0;      ///< nodes, leaves and copies of vertices; not the meshes
    std::size_t node_count = 0; ///< inner nodes and leaves; 0 where unknown
    std::size_t leaf_count = 0;
    std::size_t primitive_count = 0;
    std::size_t skipped_count = 0; ///< primitives that are not traceable
    int depth = 0;                 ///< of the deepest leaf, the root being 0
    double sah_cost = 0;           ///< C_t = C_i = 1, relative to the root's area; 0 where unknown
};

/// Ray queries over one GeometryView, which must outlive it. Safe to call from any number of
/// threads. Invalid rays (see is_valid) miss. Of several hits at the same t naive and sah return
/// the lowest (geometry, primitive), Embree the one that it meets first.
class Intersector {
  public:
    Intersector() = default;
    Intersector(const Intersector&) = delete;
    Intersector& operator=(const Intersector&) = delete;
    virtual ~Intersector() = default;

    [[nodiscard]] virtual Hit closest(const Ray& ray) const = 0;
    /// Whether any hit exists; equal to closest(ray).valid().
    [[nodiscard]] virtual bool occluded(const Ray& ray) const = 0;
    /// closest() of each ray; both spans have the same size. Hundreds of rays are faster together
    /// than one by one, most of all where neighbours run alike (camera rays in blocks of pixels) or
    /// the scene is larger than the cache; the hits are the same bits.
    virtual void closest(std::span<const Ray> rays, std::span<Hit> hits) const;
    /// occluded() of each ray, 1 or 0; both spans have the same size.
    virtual void occluded(std::span<const Ray> rays, std::span<std::uint8_t> found) const;
    /// What single-ray queries for these rays touch; zeros where the structure does not count.
    [[nodiscard]] virtual TraversalCounts count(std::span<const Ray> rays, bool any_hit) const;
    [[nodiscard]] virtual AccelStats stats() const = 0;
};

/// Builds an intersector. Throws std::bad_alloc where memory ends and std::runtime_error where the
/// kind is not available or does not support the options.
[[nodiscard]] std::unique_ptr<Intersector> make_intersector(AccelKind kind, GeometryView geometry,
                                                            const BuildOptions& options = {});

[[nodiscard]] std::string_view name_of(AccelKind kind);
[[nodiscard]] std::string_view name_of(BuildQuality quality);
[[nodiscard]] std::string_view name_of(Isa isa);

} // namespace plumb
