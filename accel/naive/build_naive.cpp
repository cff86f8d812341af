#include "accel/naive/build_naive.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace plumb {
namespace {

struct Entry {
    Bounds bounds;
    std::uint32_t geometry, primitive;
};

struct ById {
    bool operator()(const Entry& a, const Entry& b) const {
        return std::pair{a.geometry, a.primitive} < std::pair{b.geometry, b.primitive};
    }
};

std::vector<Entry> traceable_primitives(const GeometryView& geometry) {
    std::vector<Entry> entries;
    entries.reserve(geometry.primitive_count());
    const auto add_all = [&](std::uint32_t id, std::size_t count) {
        for (std::uint32_t i = 0; i < count; ++i)
            if (is_traceable(geometry, id, i))
                entries.push_back({primitive_bounds(geometry, id, i), id, i});
    };
    for (std::uint32_t mesh = 0; mesh < geometry.sphere_geometry(); ++mesh)
        add_all(mesh, geometry.meshes[mesh].triangles.size());
    add_all(geometry.sphere_geometry(), geometry.spheres.size());
    return entries;
}

int longest_axis(Vec3 extent) {
    return extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
}

/// Orders the entries so that the lower half along the longest axis of the centroids comes first.
void split_at_median(std::span<Entry> entries) {
    Bounds centers;
    for (const Entry& entry : entries)
        centers.extend(entry.bounds.center());
    const int axis = longest_axis(centers.extent());
    const auto middle = entries.begin() + static_cast<std::ptrdiff_t>(entries.size() / 2);
    std::nth_element(entries.begin(), middle, entries.end(), [&](const Entry& a, const Entry& b) {
        const float ca = a.bounds.center()[axis], cb = b.bounds.center()[axis];
        return ca < cb || (ca == cb && ById{}(a, b));
    });
}

/// Appends the subtree of the entries (at least one) and returns the index of its root.
std::uint32_t append_subtree(std::span<Entry> entries, std::vector<NaiveNode>& nodes) {
    const auto index = static_cast<std::uint32_t>(nodes.size());
    nodes.emplace_back();
    if (entries.size() == 1) {
        nodes[index].bounds = entries[0].bounds;
        nodes[index].geometry = entries[0].geometry;
        nodes[index].primitive = entries[0].primitive;
        return index;
    }
    split_at_median(entries);
    const std::size_t half = entries.size() / 2;
    const std::uint32_t left = append_subtree(entries.first(half), nodes);
    const std::uint32_t right = append_subtree(entries.subspan(half), nodes);
    nodes[index].bounds = nodes[left].bounds;
    nodes[index].bounds.extend(nodes[right].bounds);
    nodes[index].left = left;
    nodes[index].right = right;
    return index;
}

} // namespace

NaiveTree build_naive(const GeometryView& geometry) {
    if (geometry.primitive_count() > std::size_t{1} << 31)
        throw std::runtime_error("naive: more than 2^31 primitives");
    std::vector<Entry> entries = traceable_primitives(geometry);
    NaiveTree tree;
    tree.skipped_count = geometry.primitive_count() - entries.size();
    if (!entries.empty()) {
        tree.nodes.reserve(2 * entries.size() - 1);
        append_subtree(entries, tree.nodes);
    }
    return tree;
}

} // namespace plumb
