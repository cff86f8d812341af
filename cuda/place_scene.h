/// \file  Copies all that a job points to into one block of memory, of the device or of the host.
#pragma once

#include "cuda/render_kernel.h"

#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

namespace plumb {

/// Hands out pieces of one block and fills them; without a block it counts the bytes only. Measure
/// first, allocate, then place for real.
class Arena {
  public:
    /// Copies `bytes` bytes into the block, which may lie on a device.
    using Copy = void (*)(std::byte* to, const void* from, std::size_t bytes);
    /// Every piece starts at a multiple of this, which suits any type; so must the block.
    static constexpr std::size_t alignment = 256;

    Arena() = default;
    Arena(std::byte* block, Copy copy) : block_(block), copy_(copy) {}

    /// Bytes handed out so far.
    [[nodiscard]] std::size_t used() const { return used_; }

    /// The copy. Empty while measuring, and for an empty span.
    template <class T> std::span<const T> place(std::span<const T> from) {
        static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= alignment);
        if (from.empty())
            return {};
        used_ = (used_ + alignment - 1) / alignment * alignment;
        const std::size_t offset = used_;
        used_ += from.size_bytes();
        if (block_ == nullptr)
            return {};
        copy_(block_ + offset, from.data(), from.size_bytes());
        return {reinterpret_cast<const T*>(block_ + offset), from.size()};
    }

  private:
    std::byte* block_ = nullptr;
    Copy copy_ = nullptr;
    std::size_t used_ = 0;
};

/// The view of a copy of everything in `tree`.
[[nodiscard]] inline SahView place(const SahView& tree, Arena& arena) {
    SahView copy = tree;
    copy.nodes = arena.place(std::span(tree.nodes, tree.node_count)).data();
    copy.blocks = arena.place(std::span(tree.blocks, tree.block_count)).data();
    copy.spheres = arena.place(std::span(tree.spheres, tree.sphere_count)).data();
    return copy;
}

[[nodiscard]] inline CompressedView place(const CompressedView& tree, Arena& arena) {
    CompressedView copy = tree;
    copy.nodes = arena.place(std::span(tree.nodes, tree.node_count)).data();
    copy.primitives = arena.place(std::span(tree.primitives, tree.primitive_count)).data();
    return copy;
}

[[nodiscard]] inline TreeViews place(const TreeViews& trees, Arena& arena) {
    return {place(trees.binary, arena), place(trees.wide, arena)};
}

[[nodiscard]] inline GeometryView place(const GeometryView& geometry, Arena& arena) {
    std::vector<MeshView> meshes;
    for (const MeshView& mesh : geometry.meshes)
        meshes.push_back({arena.place(mesh.positions), arena.place(mesh.triangles)});
    return {arena.place(std::span<const MeshView>(meshes)), arena.place(geometry.spheres)};
}

/// The view of a copy of everything in `scene`.
[[nodiscard]] inline SceneView place(const SceneView& scene, Arena& arena) {
    std::vector<std::span<const Vec3>> normals;
    for (const std::span<const Vec3>& mesh : scene.normals)
        normals.push_back(arena.place(mesh));
    SceneView copy = scene;
    copy.geometry = place(scene.geometry, arena);
    copy.normals = arena.place(std::span<const std::span<const Vec3>>(normals));
    copy.surfaces = arena.place(scene.surfaces);
    copy.surface_lights = arena.place(scene.surface_lights);
    copy.materials = arena.place(scene.materials);
    copy.lights = arena.place(scene.lights);
    copy.light_cdf = arena.place(scene.light_cdf);
    return copy;
}

/// What kernels are launched with, but for film and batch, with copies of all that it points to.
[[nodiscard]] inline DeviceJob place(const RenderJob& job, const TreeViews& trees, Arena& arena) {
    DeviceJob device;
    device.job = job;
    device.job.scene = place(job.scene, arena);
    device.filter = arena.place(std::span(&job.filter, 1)).data();
    device.trees = place(trees, arena);
    return device;
}

/// Bytes that they take.
[[nodiscard]] inline std::size_t placed_size(const RenderJob& job, const TreeViews& trees) {
    Arena measure;
    static_cast<void>(place(job, trees, measure));
    return measure.used();
}

} // namespace plumb
