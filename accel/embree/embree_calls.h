/// \file  The calls in which Embree 3 and 4 differ. Private to this folder: nobody else sees
/// Embree.
#pragma once

#include "accel/intersector.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <array>
#include <cmath>

namespace plumb::embree {

inline constexpr unsigned packet_width = 16;
/// -1 for each lane that takes part, else 0. Embree loads it aligned.
struct alignas(64) PacketMask : std::array<int, packet_width> {};

/// What Embree wants to know of rays beside the rays: made once for any number of queries.
class Query {
  public:
    /// \param coherent  neighbouring lanes of packets run alike
#if RTC_VERSION_MAJOR >= 4
    explicit Query(bool coherent) {
        rtcInitIntersectArguments(&intersect_);
        rtcInitOccludedArguments(&occluded_);
        if (coherent)
            intersect_.flags = occluded_.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    }
    void closest(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray, &intersect_); }
    void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray, &occluded_); }
    void closest(const PacketMask& lanes, RTCScene scene, RTCRayHit16& rays) {
        rtcIntersect16(lanes.data(), scene, &rays, &intersect_);
    }
    void occluded(const PacketMask& lanes, RTCScene scene, RTCRay16& rays) {
        rtcOccluded16(lanes.data(), scene, &rays, &occluded_);
    }

  private:
    RTCIntersectArguments intersect_;
    RTCOccludedArguments occluded_;
#else
    explicit Query(bool coherent) {
        rtcInitIntersectContext(&context_);
        if (coherent)
            context_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    }
    void closest(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &context_, &ray); }
    void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &context_, &ray); }
    void closest(const PacketMask& lanes, RTCScene scene, RTCRayHit16& rays) {
        rtcIntersect16(lanes.data(), scene, &context_, &rays);
    }
    void occluded(const PacketMask& lanes, RTCScene scene, RTCRay16& rays) {
        rtcOccluded16(lanes.data(), scene, &context_, &rays);
    }

  private:
    RTCIntersectContext context_;
#endif
};

/// Embree's triangles take t >= tnear, ours t > tmin.
inline float to_tnear(float tmin) { return std::nextafter(tmin, infinity); }

inline RTCRay to_embree(const Ray& ray) {
    RTCRay r{};
    r.org_x = ray.origin.x;
    r.org_y = ray.origin.y;
    r.org_z = ray.origin.z;
    r.tnear = to_tnear(ray.tmin);
    r.dir_x = ray.direction.x;
    r.dir_y = ray.direction.y;
    r.dir_z = ray.direction.z;
    r.tfar = ray.tmax;
    r.mask = 0xffffffffu;
    return r;
}

inline RTCRayHit to_embree_query(const Ray& ray) {
    RTCRayHit query{};
    query.ray = to_embree(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.primID = RTC_INVALID_GEOMETRY_ID;
    return query;
}

/// Writes a ray into one lane.
inline void set_lane(RTCRay16& rays, unsigned lane, const Ray& ray) {
    rays.org_x[lane] = ray.origin.x;
    rays.org_y[lane] = ray.origin.y;
    rays.org_z[lane] = ray.origin.z;
    rays.tnear[lane] = to_tnear(ray.tmin);
    rays.dir_x[lane] = ray.direction.x;
    rays.dir_y[lane] = ray.direction.y;
    rays.dir_z[lane] = ray.direction.z;
    rays.tfar[lane] = ray.tmax;
    rays.time[lane] = 0;
    rays.mask[lane] = 0xffffffffu;
    rays.id[lane] = 0;
    rays.flags[lane] = 0;
}

inline void set_lane(RTCRayHit16& rays, unsigned lane, const Ray& ray) {
    set_lane(rays.ray, lane, ray);
    rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    rays.hit.primID[lane] = RTC_INVALID_GEOMETRY_ID;
    rays.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
}

/// A miss where t, u or v is not finite.
inline Hit to_hit(float t, float u, float v, unsigned geometry, unsigned primitive) {
    if (geometry == RTC_INVALID_GEOMETRY_ID || !std::isfinite(t) || !std::isfinite(u) ||
        !std::isfinite(v))
        return {};
    return {t, u, v, geometry, primitive, invalid_id};
}

inline Hit to_hit(const RTCRayHit& query) {
    return to_hit(query.ray.tfar, query.hit.u, query.hit.v, query.hit.geomID, query.hit.primID);
}

inline Hit to_hit(const RTCRayHit16& rays, unsigned lane) {
    return to_hit(rays.ray.tfar[lane], rays.hit.u[lane], rays.hit.v[lane], rays.hit.geomID[lane],
                  rays.hit.primID[lane]);
}

} // namespace plumb::embree
