#include "accel/embree/embree_peer.h"

#include "accel/embree/embree_calls.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <variant>
#include <vector>
#include <xmmintrin.h>

namespace plumb {
namespace {

using embree::packet_width;

struct Packet {
    RTCRayHit16 rays;
    embree::PacketMask lanes;
};
struct AnyHitPacket {
    RTCRay16 rays;
    embree::PacketMask lanes;
};
using Prepared = std::variant<std::vector<RTCRayHit>, std::vector<RTCRay>, std::vector<Packet>,
                              std::vector<AnyHitPacket>>;

/// Sets the thread's MXCSR bits and puts the register back.
class FlushDenormals {
  public:
    FlushDenormals() : saved_(_mm_getcsr()) {
        constexpr unsigned flush_to_zero = 1u << 15u, denormals_are_zero = 1u << 6u;
        _mm_setcsr(saved_ | flush_to_zero | denormals_are_zero);
    }
    ~FlushDenormals() { _mm_setcsr(saved_); }
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

  private:
    unsigned saved_;
};

std::uint64_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }

/// With denormals read as zero, the smallest tnear above a tmin of 0 is the smallest normal number.
Ray without_denormals(Ray ray) {
    ray.tmin = std::max(ray.tmin, std::numeric_limits<float>::min());
    return ray;
}

template <class P> std::vector<P> packets_of(std::span<const Ray> rays) {
    std::vector<P> packets((rays.size() + packet_width - 1) / packet_width);
    for (std::size_t i = 0; i < packets.size() * packet_width; ++i) {
        P& packet = packets[i / packet_width];
        const auto lane = static_cast<unsigned>(i % packet_width);
        packet.lanes[lane] = i < rays.size() ? -1 : 0;
        embree::set_lane(packet.rays, lane, without_denormals(rays[std::min(i, rays.size() - 1)]));
    }
    return packets;
}

template <class Q, class F> std::vector<Q> singles_of(std::span<const Ray> rays, F&& convert) {
    std::vector<Q> queries(rays.size());
    std::transform(rays.begin(), rays.end(), queries.begin(),
                   [&](const Ray& ray) { return convert(without_denormals(ray)); });
    return queries;
}

Prepared prepare(std::span<const Ray> rays, bool any_hit, int packet) {
    if (packet == 1 && any_hit)
        return singles_of<RTCRay>(rays, embree::to_embree);
    if (packet == 1)
        return singles_of<RTCRayHit>(rays, embree::to_embree_query);
    if (any_hit)
        return packets_of<AnyHitPacket>(rays);
    return packets_of<Packet>(rays);
}

// One query of each kind; `keep` receives its answers and is nothing while time is taken.

Hit anonymous(float tfar) { return tfar == -infinity ? Hit{0, 0, 0, 0, 0, invalid_id} : Hit{}; }

template <class Keep>
std::uint64_t query(embree::Query& q, RTCScene scene, const RTCRayHit& prepared, Keep&& keep) {
    RTCRayHit ray = prepared;
    q.closest(scene, ray);
    keep([&](unsigned) { return embree::to_hit(ray); }, 1);
    return bits(ray.ray.tfar) + ray.hit.primID;
}

template <class Keep>
std::uint64_t query(embree::Query& q, RTCScene scene, const RTCRay& prepared, Keep&& keep) {
    RTCRay ray = prepared;
    q.occluded(scene, ray);
    keep([&](unsigned) { return anonymous(ray.tfar); }, 1);
    return bits(ray.tfar);
}

template <class Keep>
std::uint64_t query(embree::Query& q, RTCScene scene, const Packet& prepared, Keep&& keep) {
    RTCRayHit16 rays = prepared.rays;
    q.closest(prepared.lanes, scene, rays);
    keep([&](unsigned lane) { return embree::to_hit(rays, lane); }, packet_width);
    std::uint64_t sum = 0;
    for (unsigned lane = 0; lane < packet_width; ++lane)
        sum += bits(rays.ray.tfar[lane]) + rays.hit.primID[lane];
    return sum;
}

template <class Keep>
std::uint64_t query(embree::Query& q, RTCScene scene, const AnyHitPacket& prepared, Keep&& keep) {
    RTCRay16 rays = prepared.rays;
    q.occluded(prepared.lanes, scene, rays);
    keep([&](unsigned lane) { return anonymous(rays.tfar[lane]); }, packet_width);
    std::uint64_t sum = 0;
    for (unsigned lane = 0; lane < packet_width; ++lane)
        sum += bits(rays.tfar[lane]);
    return sum;
}

template <class Keep>
std::uint64_t trace_all(RTCScene scene, const Prepared& prepared, bool coherent, Keep&& keep) {
    const FlushDenormals flush;
    return std::visit(
        [&](const auto& queries) {
            embree::Query q(coherent);
            std::uint64_t sum = 0;
            for (const auto& element : queries)
                sum += query(q, scene, element, keep);
            return sum;
        },
        prepared);
}

} // namespace

struct EmbreeRays::Parts {
    Prepared prepared;
    std::size_t size;
    bool any_hit, coherent;
};

EmbreeRays::EmbreeRays(std::span<const Ray> rays, bool any_hit, int packet, bool coherent)
    : parts_(std::make_unique<Parts>(
          Parts{prepare(rays, any_hit, packet), rays.size(), any_hit, packet > 1 && coherent})) {}
EmbreeRays::~EmbreeRays() = default;
EmbreeRays::EmbreeRays(EmbreeRays&&) noexcept = default;
EmbreeRays& EmbreeRays::operator=(EmbreeRays&&) noexcept = default;
std::size_t EmbreeRays::size() const { return parts_->size; }
bool EmbreeRays::any_hit() const { return parts_->any_hit; }

std::uint64_t EmbreePeer::trace(const EmbreeRays& rays) const {
    return trace_all(static_cast<RTCScene>(scene_.handle()), rays.parts_->prepared,
                     rays.parts_->coherent, [](const auto&, unsigned) {});
}

std::uint64_t EmbreePeer::trace(const EmbreeRays& rays, std::span<Hit> hits) const {
    std::size_t next = 0;
    return trace_all(static_cast<RTCScene>(scene_.handle()), rays.parts_->prepared,
                     rays.parts_->coherent, [&](const auto& hit, unsigned count) {
                         for (unsigned lane = 0; lane < count && next < hits.size(); ++lane)
                             hits[next++] = hit(lane);
                     });
}

} // namespace plumb
