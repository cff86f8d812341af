#include "accel/sah/primitive_ref.h"

#include <algorithm>

namespace plumb {
namespace {

constexpr std::size_t chunk_size = 8192;

/// What one chunk of the primitives gave.
struct Chunk {
    std::size_t count = 0;
    Box bounds, centroids;
};

/// primitive_bounds of a triangle, the same operations in the same order.
Box triangle_box(Float4 a, Float4 b, Float4 c) {
    using namespace float4;
    const Float4 lower = min(a, min(b, c)), upper = max(a, max(b, c));
    const Float4 d = subtract(upper, lower);
    const Float4 largest = max(d, max(rotate(d), rotate(rotate(d))));
    const Float4 margin = multiply(broadcast(8 * unit_roundoff), largest);
    const Float4 ulp = broadcast(2 * unit_roundoff);
    return {subtract(lower, add(margin, multiply(ulp, abs(lower)))),
            add(upper, add(margin, multiply(ulp, abs(upper))))};
}

bool is_finite(Float4 a, Float4 b, Float4 c) {
    using namespace float4;
    const Float4 limit = broadcast(std::nextafter(max_coordinate, infinity));
    return (less(abs(a), limit) & less(abs(b), limit) & less(abs(c), limit)) == 15;
}

bool differ(Float4 a, Float4 b) {
    return ((float4::less(a, b) | float4::less(b, a)) & 7) != 0;
}

/// Appends the traceable primitives of a range of numbers.
class Appender {
  public:
    Appender(const GeometryView& geometry, PrimitiveRef* to) : geometry_(geometry), to_(to) {}

    void add_triangles(const MeshView& mesh, std::size_t begin, std::size_t end,
                       PrimitiveNumber number) {
        for (std::size_t i = begin; i < end; ++i, ++number) {
            const Triangle t = mesh.triangles[i];
            const Float4 a = float4::load(mesh.positions[t.a]);
            const Float4 b = float4::load(mesh.positions[t.b]);
            const Float4 c = float4::load(mesh.positions[t.c]);
            if (is_finite(a, b, c) && differ(a, b) && differ(b, c) && differ(c, a))
                add(triangle_box(a, b, c), number);
        }
    }
    void add_spheres(std::uint32_t begin, std::uint32_t end, PrimitiveNumber number) {
        const std::uint32_t id = geometry_.sphere_geometry();
        for (std::uint32_t i = begin; i < end; ++i, ++number) {
            const Bounds b = primitive_bounds(geometry_, id, i);
            if (is_traceable(geometry_, id, i))
                add({float4::load(b.lower), float4::load(b.upper)}, number);
        }
    }
    [[nodiscard]] const Chunk& result() const { return chunk_; }

  private:
    void add(Box box, PrimitiveNumber number) {
        // -0 becomes +0: minima and maxima then have the same bits in any order.
        const Float4 zero = float4::broadcast(0);
        box = {float4::add(box.lower, zero), float4::add(box.upper, zero)};
        to_[chunk_.count++].set(box, number);
        chunk_.bounds.extend(box);
        chunk_.centroids.extend_point(centroid(box));
    }

    const GeometryView& geometry_;
    PrimitiveRef* to_;
    Chunk chunk_;
};

Chunk fill(const GeometryView& geometry, const PrimitiveNumbers& numbers, std::size_t begin,
           std::size_t end, PrimitiveRef* to) {
    Appender appender(geometry, to);
    std::uint32_t g = numbers.id(static_cast<PrimitiveNumber>(begin)).geometry;
    for (; begin < end; ++g) {
        const std::size_t first = numbers.first_of(g);
        const std::size_t stop = std::min<std::size_t>(end, numbers.first_of(g + 1));
        const auto number = static_cast<PrimitiveNumber>(begin);
        if (geometry.is_sphere(g))
            appender.add_spheres(static_cast<std::uint32_t>(begin - first),
                                 static_cast<std::uint32_t>(stop - first), number);
        else
            appender.add_triangles(geometry.meshes[g], begin - first, stop - first, number);
        begin = stop;
    }
    return appender.result();
}

} // namespace

void PrimitiveRange::measure(const Workers& workers) {
    std::vector<Chunk> chunks((refs.size() + chunk_size - 1) / chunk_size);
    workers.for_each(chunks.size(), [&](std::size_t i) {
        Chunk chunk; // in registers
        const std::size_t begin = i * chunk_size;
        for (const PrimitiveRef& ref :
             refs.subspan(begin, std::min(chunk_size, refs.size() - begin))) {
            const Box box = ref.box();
            chunk.bounds.extend(box);
            chunk.centroids.extend_point(centroid(box));
        }
        chunks[i] = chunk;
    });
    bounds = {};
    centroids = {};
    for (const Chunk& chunk : chunks) {
        bounds.extend(chunk.bounds);
        centroids.extend(chunk.centroids);
    }
}

PrimitiveNumbers::PrimitiveNumbers(const GeometryView& geometry) {
    first_.reserve(geometry.meshes.size() + 2);
    first_.push_back(0);
    for (const MeshView& mesh : geometry.meshes)
        first_.push_back(first_.back() + static_cast<PrimitiveNumber>(mesh.triangles.size()));
    first_.push_back(first_.back() + static_cast<PrimitiveNumber>(geometry.spheres.size()));
}

PrimitiveNumbers::Id PrimitiveNumbers::id(PrimitiveNumber number) const {
    const auto after = std::upper_bound(first_.begin() + 1, first_.end(), number);
    const auto geometry = static_cast<std::uint32_t>(after - first_.begin() - 1);
    return {geometry, number - first_[geometry]};
}

PrimitiveRefs make_primitive_refs(const GeometryView& geometry, const PrimitiveNumbers& numbers,
                                  std::size_t capacity, const Workers& workers) {
    const std::size_t total = geometry.primitive_count();
    PrimitiveRefs refs{std::make_unique_for_overwrite<PrimitiveRef[]>(std::max(capacity, total)),
                       {}};
    std::vector<Chunk> chunks((total + chunk_size - 1) / chunk_size);
    workers.for_each(chunks.size(), [&](std::size_t i) {
        const std::size_t begin = i * chunk_size, end = std::min(total, begin + chunk_size);
        chunks[i] = fill(geometry, numbers, begin, end, &refs.data[begin]);
    });
    std::size_t count = 0;
    for (std::size_t i = 0; i < chunks.size(); ++i) {
        const PrimitiveRef* from = &refs.data[i * chunk_size];
        if (count != i * chunk_size) // chunks before this one have gaps
            std::copy(from, from + chunks[i].count, &refs.data[count]);
        count += chunks[i].count;
        refs.all.bounds.extend(chunks[i].bounds);
        refs.all.centroids.extend(chunks[i].centroids);
    }
    refs.all.refs = {refs.data.get(), count};
    return refs;
}

} // namespace plumb
