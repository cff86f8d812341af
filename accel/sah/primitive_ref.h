/// \file  The primitives as the builder moves them about: 32 bytes each.
#pragma once

#include "accel/parallel/parallel.h"
#include "accel/sah/binary_bvh.h"
#include "accel/sah/float4.h"

#include <memory>

namespace plumb {

using float4::Box;
using float4::Float4;

/// A primitive with its box, or with the part of its box that a spatial split left to it. No
/// member initialisers: arrays of these are made without being written.
struct alignas(32) PrimitiveRef {
    float lower[3];
    PrimitiveNumber number;
    float upper[3];
    std::uint32_t side; ///< for the spatial split that is being carried out

    [[nodiscard]] Box box() const { return {float4::load_xyz(lower), float4::load_xyz(upper)}; }
    void set(const Box& box, PrimitiveNumber n) {
        float4::store(lower, box.lower);
        float4::store(upper, box.upper);
        number = n;
    }
};
static_assert(sizeof(PrimitiveRef) == 32);

/// Twice the centre of a box.
[[nodiscard]] inline Float4 centroid(const Box& box) { return float4::add(box.lower, box.upper); }

/// Primitives with the box around them and the box around their centroids.
struct PrimitiveRange {
    std::span<PrimitiveRef> refs;
    Box bounds, centroids;

    [[nodiscard]] std::size_t size() const { return refs.size(); }
    /// Along which the centroids spread most.
    [[nodiscard]] int widest_axis() const {
        const Vec3 extent = centroids.bounds().extent();
        return extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    }
    void measure(const Workers& workers);
};

/// Where the primitive numbers of each geometry begin.
class PrimitiveNumbers {
  public:
    explicit PrimitiveNumbers(const GeometryView& geometry);

    struct Id {
        std::uint32_t geometry, primitive;
    };
    [[nodiscard]] Id id(PrimitiveNumber number) const;
    [[nodiscard]] PrimitiveNumber first_of(std::uint32_t geometry) const {
        return first_[geometry];
    }
    [[nodiscard]] PrimitiveNumber first_sphere() const { return first_[first_.size() - 2]; }

  private:
    std::vector<PrimitiveNumber> first_; ///< of each geometry, the spheres', and the end
};

/// All traceable primitives in ascending order, in an array with room for `capacity` or for all
/// primitives, whichever is more.
struct PrimitiveRefs {
    std::unique_ptr<PrimitiveRef[]> data;
    PrimitiveRange all;
};
[[nodiscard]] PrimitiveRefs make_primitive_refs(const GeometryView& geometry,
                                                const PrimitiveNumbers& numbers,
                                                std::size_t capacity, const Workers& workers);

} // namespace plumb
