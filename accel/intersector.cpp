#include "accel/intersector.h"

namespace plumb {

void Intersector::closest(std::span<const Ray> rays, std::span<Hit> hits) const {
    for (std::size_t i = 0; i < rays.size(); ++i)
        hits[i] = closest(rays[i]);
}

void Intersector::occluded(std::span<const Ray> rays, std::span<std::uint8_t> found) const {
    for (std::size_t i = 0; i < rays.size(); ++i)
        found[i] = occluded(rays[i]) ? 1 : 0;
}

TraversalCounts Intersector::count(std::span<const Ray> /*rays*/, bool /*any_hit*/) const {
    return {};
}

std::string_view name_of(AccelKind kind) {
    switch (kind) {
    case AccelKind::naive: return "naive";
    case AccelKind::sah: return "sah";
    case AccelKind::embree: return "embree";
    }
    return "unknown";
}

std::string_view name_of(BuildQuality quality) {
    switch (quality) {
    case BuildQuality::fast: return "fast";
    case BuildQuality::medium: return "medium";
    case BuildQuality::high: return "high";
    }
    return "unknown";
}

std::string_view name_of(Isa isa) {
    switch (isa) {
    case Isa::automatic: return "auto";
    case Isa::portable: return "portable";
    case Isa::avx2: return "avx2";
    case Isa::avx512: return "avx512";
    }
    return "unknown";
}

} // namespace plumb
