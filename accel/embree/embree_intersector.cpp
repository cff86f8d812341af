#include "accel/embree/embree_intersector.h"

#include "accel/embree/embree_calls.h"
#include "accel/embree/embree_scene.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace plumb {
namespace {

using embree::packet_width;

bool ordinary(float x) { return x == 0 || (std::fabs(x) > 1e-9f && std::fabs(x) < 1e9f); }

/// The lanes from `first` on that hold valid rays, written into `packet`.
template <class Packet>
embree::PacketMask fill(std::span<const Ray> rays, std::size_t first, Packet& packet) {
    static constexpr Ray harmless{{}, 0, {0, 0, 1}, 0};
    embree::PacketMask lanes{};
    for (unsigned lane = 0; lane < packet_width; ++lane) {
        const bool takes_part = first + lane < rays.size() && is_valid(rays[first + lane]);
        lanes[lane] = takes_part ? -1 : 0;
        embree::set_lane(packet, lane, takes_part ? rays[first + lane] : harmless);
    }
    return lanes;
}

class EmbreeIntersector final : public Intersector {
  public:
    EmbreeIntersector(const GeometryView& geometry, const EmbreeOptions& options)
        : EmbreeIntersector(geometry, options, std::chrono::steady_clock::now()) {}

    [[nodiscard]] Hit closest(const Ray& ray) const override {
        if (!is_valid(ray))
            return {};
        RTCRayHit query = embree::to_embree_query(ray);
        embree::Query(false).closest(handle(), query);
        return embree::to_hit(query);
    }

    [[nodiscard]] bool occluded(const Ray& ray) const override {
        if (!is_valid(ray))
            return false;
        RTCRay query = embree::to_embree(ray);
        embree::Query(false).occluded(handle(), query);
        return confirmed(query.tfar, ray);
    }

    void closest(std::span<const Ray> rays, std::span<Hit> hits) const override {
        if (packet_ == 1)
            return Intersector::closest(rays, hits);
        embree::Query query(true);
        for (std::size_t first = 0; first < rays.size(); first += packet_width) {
            RTCRayHit16 packet;
            const embree::PacketMask lanes = fill(rays, first, packet);
            query.closest(lanes, handle(), packet);
            const auto count = std::min<std::size_t>(packet_width, rays.size() - first);
            for (unsigned lane = 0; lane < count; ++lane)
                hits[first + lane] = lanes[lane] != 0 ? embree::to_hit(packet, lane) : Hit{};
        }
    }

    void occluded(std::span<const Ray> rays, std::span<std::uint8_t> found) const override {
        if (packet_ == 1)
            return Intersector::occluded(rays, found);
        embree::Query query(true);
        for (std::size_t first = 0; first < rays.size(); first += packet_width) {
            RTCRay16 packet;
            const embree::PacketMask lanes = fill(rays, first, packet);
            query.occluded(lanes, handle(), packet);
            const auto count = std::min<std::size_t>(packet_width, rays.size() - first);
            for (unsigned lane = 0; lane < count; ++lane)
                found[first + lane] =
                    lanes[lane] != 0 && confirmed(packet.tfar[lane], rays[first + lane]) ? 1 : 0;
        }
    }

    [[nodiscard]] AccelStats stats() const override {
        AccelStats stats;
        stats.build_s = build_s_;
        stats.bytes = scene_.bytes();
        stats.skipped_count = skipped_count_;
        stats.primitive_count = geometry_.primitive_count() - skipped_count_;
        return stats;
    }

  private:
    EmbreeIntersector(const GeometryView& geometry, const EmbreeOptions& options,
                      std::chrono::steady_clock::time_point start)
        : geometry_(geometry), scene_(geometry, options), packet_(options.packet) {
        for (std::uint32_t mesh = 0; mesh < geometry_.meshes.size(); ++mesh)
            for (std::uint32_t i = 0; i < geometry_.meshes[mesh].triangles.size(); ++i)
                note_triangle(mesh, i);
        for (std::uint32_t i = 0; i < geometry_.spheres.size(); ++i)
            skipped_count_ += is_traceable(geometry_, geometry_.sphere_geometry(), i) ? 0u : 1u;
        build_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }

    void note_triangle(std::uint32_t mesh, std::uint32_t triangle) {
        if (!is_traceable(geometry_, mesh, triangle)) {
            ++skipped_count_;
            return;
        }
        const Bounds box = primitive_bounds(geometry_, mesh, triangle);
        const float largest =
            std::max(max_component(abs(box.lower)), max_component(abs(box.upper)));
        const float size = max_component(box.extent());
        extreme_ = extreme_ || largest > 1e9f || (size > 0 && size < 1e-9f);
    }

    [[nodiscard]] RTCScene handle() const { return static_cast<RTCScene>(scene_.handle()); }

    /// An any-hit query does not tell t, u and v. Where they may have overflowed, closest() is
    /// asked, which rejects such hits.
    [[nodiscard]] bool confirmed(float tfar, const Ray& ray) const {
        const bool found = tfar == -infinity;
        const bool finite = !extreme_ && ordinary(ray.direction.x) && ordinary(ray.direction.y) &&
                            ordinary(ray.direction.z) && max_component(abs(ray.origin)) < 1e9f;
        return found && (finite || closest(ray).valid());
    }

    GeometryView geometry_;
    EmbreeScene scene_;
    int packet_;
    std::size_t skipped_count_ = 0;
    bool extreme_ = false; ///< coordinates at which Embree's products may overflow or vanish
    double build_s_ = 0;
};

} // namespace

std::unique_ptr<Intersector> make_embree_intersector(const GeometryView& geometry,
                                                     const EmbreeOptions& options) {
    if (options.packet != 1 && options.packet != static_cast<int>(packet_width))
        throw std::runtime_error("embree: packets are 1 or 16 rays wide");
    return std::make_unique<EmbreeIntersector>(geometry, options);
}

std::unique_ptr<Intersector> make_embree_intersector(const GeometryView& geometry,
                                                     const BuildOptions& options) {
    if (options.triangle_test != TriangleTest::watertight)
        throw std::runtime_error("embree has its own watertight triangle test: "
                                 "Möller-Trumbore needs the naive or the sah structure");
    EmbreeOptions embree;
    embree.quality = options.quality;
    embree.threads = options.threads;
    return make_embree_intersector(geometry, embree);
}

} // namespace plumb
