/// \file  Embree as a benchmark should time it: rays prepared beforehand, nothing between the
/// calls.
#pragma once

#include "accel/embree/embree_scene.h"

namespace plumb {

/// Rays in Embree's own layout, aligned, made once outside all timing.
class EmbreeRays {
  public:
    /// \param rays      all valid
    /// \param packet    1, or 16: 16 neighbours become one packet
    /// \param coherent  whether packets get the coherent flag
    EmbreeRays(std::span<const Ray> rays, bool any_hit, int packet, bool coherent = true);
    ~EmbreeRays();
    EmbreeRays(EmbreeRays&&) noexcept;
    EmbreeRays& operator=(EmbreeRays&&) noexcept;
    [[nodiscard]] std::size_t size() const;
    [[nodiscard]] bool any_hit() const;

  private:
    friend class EmbreePeer;
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// A scene without the wrapper's checks of rays and hits.
class EmbreePeer {
  public:
    /// Throws what EmbreeScene throws.
    EmbreePeer(const GeometryView& geometry, const EmbreeOptions& options)
        : scene_(geometry, options) {}

    /// The loop to time: each ray is copied to a local and traced, alone or in packets as it was
    /// prepared. Flush-to-zero and denormals-are-zero are set meanwhile, as Embree recommends.
    /// Returns a checksum of the answers, the same for the same answers: of closest hits the sum of
    /// the bits of t and the primitive's id, of any-hit queries the sum of the bits of t (Embree
    /// marks a hit by minus infinity).
    [[nodiscard]] std::uint64_t trace(const EmbreeRays& rays) const;

    /// The same rays, answers kept: one hit for each ray, or t = 0 of an anonymous hit (geometry
    /// and primitive 0) where an any-hit query found one. Returns trace()'s checksum.
    [[nodiscard]] std::uint64_t trace(const EmbreeRays& rays, std::span<Hit> hits) const;

    [[nodiscard]] const EmbreeScene& scene() const { return scene_; }

  private:
    EmbreeScene scene_;
};

} // namespace plumb
