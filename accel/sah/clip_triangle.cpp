#include "accel/sah/clip_triangle.h"

namespace plumb {
namespace {

/// Height over length below which a triangle is a sliver.
constexpr float sliver = 1e-5f;

float squared_length(Float4 a) {
    const Float4 p = float4::multiply(a, a);
    const Float4 yz = float4::rotate(p);
    return float4::first(float4::add(float4::add(p, yz), float4::rotate(yz)));
}

Float4 cross(Float4 a, Float4 b) {
    using namespace float4;
    // (a x b) rotated twice: its length is the same
    return subtract(multiply(a, rotate(b)), multiply(rotate(a), b));
}

} // namespace

ClipTriangle::ClipTriangle(const TriangleVertices& t, Float4 area_scale)
    : vertex_{float4::load(t.a), float4::load(t.b), float4::load(t.c)},
      coordinate_{float4::set(t.a.x, t.b.x, t.c.x), float4::set(t.a.y, t.b.y, t.c.y),
                  float4::set(t.a.z, t.b.z, t.c.z)} {
    using namespace float4;
    Box box;
    for (int i = 0; i < 3; ++i) {
        box.extend_point(vertex_[i]);
    }
    const Float4 d = box.extent();
    margin_ = multiply(broadcast(16 * unit_roundoff), max(d, max(rotate(d), rotate(rotate(d)))));
    const Float4 e1 = multiply(subtract(vertex_[1], vertex_[0]), area_scale);
    const Float4 e2 = multiply(subtract(vertex_[2], vertex_[0]), area_scale);
    const float size = squared_length(multiply(d, area_scale));
    can_be_cut_ = squared_length(cross(e1, e2)) > sliver * sliver * size * size;
}

Box ClipTriangle::padded(Box part, const Box& within) const {
    using namespace float4;
    const Float4 ulp = broadcast(4 * unit_roundoff), zero = broadcast(0);
    part.lower = subtract(part.lower, add(margin_, multiply(ulp, abs(part.lower))));
    part.upper = add(part.upper, add(margin_, multiply(ulp, abs(part.upper))));
    // + 0: see make_primitive_refs
    part.lower = add(max(part.lower, within.lower), zero);
    part.upper = add(min(part.upper, within.upper), zero);
    return part.is_empty() ? Box{} : part;
}

/// Without branches: where the vertices are cannot be guessed.
void ClipTriangle::cut(int axis, float plane, const Box& box, Box& below, Box& above) const {
    using namespace float4;
    const auto next = [](unsigned bits) { return (bits >> 1 | bits << 2) & 7u; };
    const Float4 x = coordinate_[axis], p = broadcast(plane);
    const unsigned is_below = less(x, p) & 7u, is_above = less(p, x) & 7u;
    const unsigned crosses = (is_below & next(is_above)) | (is_above & next(is_below));
    alignas(16) float t[4]; // where the edge from each vertex to the next meets the plane
    store(t, divide(subtract(p, x), subtract(rotate(x), x)));
    Box low, high;
    for (unsigned i = 0; i < 3; ++i) {
        const Float4 a = vertex_[i], b = vertex_[i == 2 ? 0 : i + 1];
        const Float4 cut =
            only_if((crosses >> i) & 1u, add(a, multiply(subtract(b, a), broadcast(t[i]))));
        low.extend_point(only_if((~is_above >> i) & 1u, a));
        high.extend_point(only_if((~is_below >> i) & 1u, a));
        low.extend_point(cut);
        high.extend_point(cut);
    }
    below = is_below != 0 || is_above == 0 ? padded(low, box) : Box{};
    above = is_above != 0 ? padded(high, box) : Box{};
}

} // namespace plumb
