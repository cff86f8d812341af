/// \file  The faces of an OBJ file: fans, and a hash table with linear probing for the corners.
#include "renderer/io/obj_faces.h"

#include <algorithm>

namespace plumb {
namespace {

/// Mixes all three indices into the lower bits (the finalizer of splitmix64, Steele et al. 2014).
std::uint64_t hash(const ObjCorner& c) {
    std::uint64_t x = (std::uint64_t{c.position} << 32 | c.uv) + c.normal * 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

} // namespace

void ObjFaces::add(std::span<const ObjCorner> polygon) {
    const bool direct = is_direct() && are_direct(polygon);
    if (is_direct() && !direct)
        leave_direct();
    const auto vertex = [&](const ObjCorner& c) { return direct ? c.position : number_of(c); };
    const std::uint32_t first = vertex(polygon[0]);
    std::uint32_t previous = vertex(polygon[1]);
    for (std::size_t i = 2; i < polygon.size(); ++i) {
        const std::uint32_t a = polygon[0].position, b = polygon[i - 1].position,
                            c = polygon[i].position;
        const std::uint32_t current = vertex(polygon[i]);
        if (a == b || b == c || c == a)
            ++degenerate_;
        else
            triangles_.push_back({first, previous, current});
        previous = current;
    }
}

bool ObjFaces::are_direct(std::span<const ObjCorner> polygon) {
    if (!any_seen_) {
        any_seen_ = true;
        with_uv_ = polygon[0].uv != invalid_id;
        with_normal_ = polygon[0].normal != invalid_id;
    }
    return std::all_of(polygon.begin(), polygon.end(), [&](const ObjCorner& c) {
        return c.uv == (with_uv_ ? c.position : invalid_id) &&
               c.normal == (with_normal_ ? c.position : invalid_id);
    });
}

/// Numbers the corners of all triangles anew, which are positions until now.
void ObjFaces::leave_direct() {
    const auto renumber = [&](std::uint32_t p) {
        return number_of({p, with_uv_ ? p : invalid_id, with_normal_ ? p : invalid_id});
    };
    for (Triangle& t : triangles_)
        t = {renumber(t.a), renumber(t.b), renumber(t.c)};
}

std::uint32_t ObjFaces::number_of(const ObjCorner& corner) {
    if (2 * corners_.size() >= table_.size())
        grow();
    const std::size_t mask = table_.size() - 1;
    std::size_t slot = hash(corner) & mask;
    for (; table_[slot] != invalid_id; slot = (slot + 1) & mask)
        if (corners_[table_[slot]] == corner)
            return table_[slot];
    table_[slot] = static_cast<std::uint32_t>(corners_.size());
    corners_.push_back(corner);
    return table_[slot];
}

void ObjFaces::grow() {
    table_.assign(table_.empty() ? 64 : 2 * table_.size(), invalid_id);
    const std::size_t mask = table_.size() - 1;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
        std::size_t slot = hash(corners_[i]) & mask;
        while (table_[slot] != invalid_id)
            slot = (slot + 1) & mask;
        table_[slot] = static_cast<std::uint32_t>(i);
    }
}

} // namespace plumb
