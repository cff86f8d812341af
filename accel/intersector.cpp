#include "accel/intersector.h"

namespace plumb {

void Intersector::closest(std::span<const Ray> rays, std::span<Hit> hits) const {
    for (std::size_t i = 0; i < rays.size(); ++i)
        hits[i] = closest(rays[i]);
}

std::string_view name_of(AccelKind kind) {
    switch (kind) {
    case AccelKind::naive: return "naive";
    case AccelKind::sah: return "sah";
    case AccelKind::embree: return "embree";
    }
    return "unknown";
}

} // namespace plumb
