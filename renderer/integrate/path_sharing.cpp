#include "renderer/integrate/path_sharing.h"

#include <utility>

namespace plumb {
namespace {

/// Vertices nearer than that share nothing: the sum of a block's densities has to be finite.
constexpr float largest_jacobian = 1e36f;

} // namespace

void PathSharing::clear(std::size_t count) {
    groups_ = 0;
    for (std::size_t slot = 0; slot < count; ++slot) {
        left_[slot] = alike_[slot] = 0;
        tail_.set(slot, {});
        own_.set(slot, {});
    }
}

void PathSharing::end_group(std::size_t end) {
    group_end_[groups_++] = static_cast<std::uint32_t>(end);
}

void PathSharing::leave_first(const PathLanes& lanes, const Vec3Lanes& shading, std::size_t i) {
    const std::size_t slot = lanes.slot[i];
    // Where nothing is reflected no path is sent on, whatever the density of its direction.
    left_[slot] = max_component(lanes.reflectance[i]) > 0 ? 1 : 0;
    first_.position.set(slot, lanes.position[i]);
    first_.error.set(slot, lanes.error[i]);
    first_.normal.set(slot, lanes.geometric[i]);
    shading_.set(slot, shading[i]);
    reflectance_.set(slot, lanes.reflectance[i]);
}

void PathSharing::reach_second(const PathLanes& lanes, std::size_t i, bool alike) {
    const std::size_t slot = lanes.slot[i];
    alike_[slot] = alike ? 1 : 0;
    second_.position.set(slot, lanes.position[i]);
    second_.error.set(slot, lanes.error[i]);
    second_.normal.set(slot, lanes.geometric[i]);
}

PathSharing::Connection PathSharing::connect(std::size_t k, std::size_t t,
                                             HemisphereSampling hemisphere) const {
    if (left_[k] == 0)
        return {0, 0};
    const Vec3 d = second_.position[t] - first_.position[k];
    const float squared = dot(d, d);
    const float leaving = dot(d, shading_[k]), arriving = -dot(d, second_.normal[t]);
    if (!(squared > 0 && leaving > 0 && arriving > 0 && dot(d, first_.normal[k]) > 0))
        return {0, 0};
    const float inverse = 1 / std::sqrt(squared);
    const float jacobian = arriving * inverse / squared;
    const Vec3 direction{0, 0, leaving * inverse};
    if (!(jacobian < largest_jacobian))
        return {0, 0};
    return {diffuse_pdf(direction, hemisphere) * jacobian, direction.z * inv_pi * jacobian};
}

Ray PathSharing::visibility_ray(std::size_t k, std::size_t t) const {
    const Vec3 d = first_.position[k] - second_.position[t];
    const Vec3 from = offset_origin(second_.position[t], second_.error[t], second_.normal[t], d);
    const Vec3 to = offset_origin(first_.position[k], first_.error[k], first_.normal[k], -d);
    return {from, 0, to - from, shadow_end};
}

void PathSharing::trace(const Intersector& intersector, std::size_t count, PathLanes& lanes) {
    intersector.occluded(std::span<const Ray>(lanes.rays.lane, count),
                         std::span<std::uint8_t>(lanes.blocked.lane, count));
    for (std::size_t r = 0; r < count; ++r)
        if (lanes.blocked[r] != 0)
            connection_[asked_[r] / max_sharing][asked_[r] % max_sharing] = {0, 0};
}

std::size_t PathSharing::share(const Intersector& intersector, HemisphereSampling hemisphere,
                               PathLanes& lanes) {
    std::size_t count = 0, traced = 0;
    std::size_t first = 0;
    for (std::size_t group = 0; group < groups_; first = group_end_[group++])
        for (std::size_t t = first; t < group_end_[group]; ++t) {
            if (alike_[t] == 0 || !(max_component(tail_[t]) > 0))
                continue;
            for (std::size_t k = first; k < group_end_[group]; ++k) {
                Connection& connection = connection_[t][k - first];
                connection = connect(k, t, hemisphere);
                if (k == t || !(connection.density > 0))
                    continue;
                asked_[count] = static_cast<std::uint32_t>(max_sharing * t + (k - first));
                lanes.rays[count++] = visibility_ray(k, t);
                if (count == max_lanes) {
                    trace(intersector, count, lanes);
                    traced += std::exchange(count, 0);
                }
            }
        }
    trace(intersector, count, lanes);
    first = 0;
    for (std::size_t group = 0; group < groups_; first = group_end_[group++])
        distribute(first, group_end_[group], lanes);
    return traced + count;
}

void PathSharing::distribute(std::size_t first, std::size_t end, PathLanes& lanes) const {
    for (std::size_t t = first; t < end; ++t) {
        const Rgb tail = tail_[t];
        if (!(max_component(tail) > 0))
            continue;
        float density = 0;
        if (alike_[t] != 0 && connection_[t][t - first].density > 0)
            for (std::size_t k = 0; k < end - first; ++k)
                density += connection_[t][k].density;
        if (!(density > 0)) { // its own alone
            lanes.radiance.set(t, lanes.radiance[t] + own_[t] * tail);
            continue;
        }
        for (std::size_t k = first; k < end; ++k) {
            const float weight = connection_[t][k - first].reflected / density;
            lanes.radiance.set(k, lanes.radiance[k] + reflectance_[k] * tail * weight);
        }
    }
}

} // namespace plumb
