#include "accel/embree/embree_intersector.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <new>
#include <stdexcept>
#include <string>

namespace plumb {
namespace {

template <class Handle, void (*Release)(Handle)> struct Releaser {
    void operator()(Handle handle) const { Release(handle); }
};
template <class Handle, void (*Release)(Handle)>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Releaser<Handle, Release>>;

using Device = Owned<RTCDevice, rtcReleaseDevice>;
using Scene = Owned<RTCScene, rtcReleaseScene>;
using Geometry = Owned<RTCGeometry, rtcReleaseGeometry>;

// The calls in which Embree 3 and 4 differ.
#if RTC_VERSION_MAJOR >= 4
void intersect(RTCScene scene, RTCRayHit& query) { rtcIntersect1(scene, &query); }
void occlude(RTCScene scene, RTCRay& query) { rtcOccluded1(scene, &query); }
#else
void intersect(RTCScene scene, RTCRayHit& query) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &query);
}
void occlude(RTCScene scene, RTCRay& query) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &query);
}
#endif

RTCRay to_embree(const Ray& ray) {
    RTCRay r{};
    r.org_x = ray.origin.x;
    r.org_y = ray.origin.y;
    r.org_z = ray.origin.z;
    r.tnear = std::nextafter(ray.tmin, infinity); // Embree's triangles take t >= tnear
    r.dir_x = ray.direction.x;
    r.dir_y = ray.direction.y;
    r.dir_z = ray.direction.z;
    r.tfar = ray.tmax;
    r.mask = 0xffffffffu;
    return r;
}

PreparedRay prepared(RTCRayN* rays, unsigned n, unsigned i) {
    return PreparedRay(
        Ray{{RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)},
            std::nextafter(RTCRayN_tnear(rays, n, i), -infinity), // tmin again
            {RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)},
            RTCRayN_tfar(rays, n, i)});
}

// The spheres: user geometry whose user pointer is the GeometryView.

const GeometryView& view_of(const void* user) { return *static_cast<const GeometryView*>(user); }

void bound_sphere(const RTCBoundsFunctionArguments* args) {
    const GeometryView& view = view_of(args->geometryUserPtr);
    // Embree leaves out primitives whose box is empty.
    const Bounds box = is_traceable(view, view.sphere_geometry(), args->primID)
                           ? sphere_bounds(view.spheres[args->primID])
                           : Bounds{};
    *args->bounds_o = {box.lower.x, box.lower.y, box.lower.z, 0,
                       box.upper.x, box.upper.y, box.upper.z, 0};
}

void intersect_spheres(const RTCIntersectFunctionNArguments* args) {
    const Sphere& sphere = view_of(args->geometryUserPtr).spheres[args->primID];
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
    RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, args->N);
    for (unsigned i = 0; i < args->N; ++i) {
        PrimitiveHit hit;
        float& tfar = RTCRayN_tfar(rays, args->N, i);
        if (args->valid[i] == 0 || !intersect_sphere(prepared(rays, args->N, i), sphere, tfar, hit))
            continue;
        tfar = hit.t;
        RTCHitN_u(hits, args->N, i) = hit.u;
        RTCHitN_v(hits, args->N, i) = hit.v;
        RTCHitN_primID(hits, args->N, i) = args->primID;
        RTCHitN_geomID(hits, args->N, i) = args->geomID;
    }
}

void occlude_spheres(const RTCOccludedFunctionNArguments* args) {
    const Sphere& sphere = view_of(args->geometryUserPtr).spheres[args->primID];
    for (unsigned i = 0; i < args->N; ++i) {
        PrimitiveHit hit;
        float& tfar = RTCRayN_tfar(args->ray, args->N, i);
        if (args->valid[i] != 0 &&
            intersect_sphere(prepared(args->ray, args->N, i), sphere, tfar, hit))
            tfar = -infinity; // Embree's mark of an occluded ray
    }
}

bool ordinary(float x) { return x == 0 || (std::fabs(x) > 1e-9f && std::fabs(x) < 1e9f); }

class EmbreeIntersector final : public Intersector {
  public:
    explicit EmbreeIntersector(const GeometryView& geometry) : geometry_(geometry) {
        const auto start = std::chrono::steady_clock::now();
        device_.reset(rtcNewDevice(nullptr));
        if (!device_)
            throw std::runtime_error("embree: no device");
        rtcSetDeviceErrorFunction(device_.get(), note_error, this);
        rtcSetDeviceMemoryMonitorFunction(device_.get(), note_memory, this);
        scene_.reset(rtcNewScene(device_.get()));
        rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_MEDIUM);
        for (std::uint32_t mesh = 0; mesh < geometry_.meshes.size(); ++mesh)
            attach_mesh(mesh);
        attach_spheres();
        rtcCommitScene(scene_.get());
        throw_on_error();
        build_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }

    using Intersector::closest;
    using Intersector::occluded;

    [[nodiscard]] Hit closest(const Ray& ray) const override {
        if (!is_valid(ray))
            return {};
        RTCRayHit query{};
        query.ray = to_embree(ray);
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        intersect(scene_.get(), query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID || !std::isfinite(query.ray.tfar) ||
            !std::isfinite(query.hit.u) || !std::isfinite(query.hit.v))
            return {};
        return {query.ray.tfar,   query.hit.u,      query.hit.v,
                query.hit.geomID, query.hit.primID, invalid_id};
    }

    [[nodiscard]] bool occluded(const Ray& ray) const override {
        if (!is_valid(ray))
            return false;
        RTCRay query = to_embree(ray);
        occlude(scene_.get(), query);
        const bool found = query.tfar == -infinity;
        // An any-hit query does not tell t, u and v. Where they may have overflowed, closest() is
        // asked, which rejects such hits.
        const bool finite = !extreme_ && ordinary(ray.direction.x) && ordinary(ray.direction.y) &&
                            ordinary(ray.direction.z) && max_component(abs(ray.origin)) < 1e9f;
        return found && (finite || closest(ray).valid());
    }

    [[nodiscard]] AccelStats stats() const override {
        AccelStats stats;
        stats.build_s = build_s_;
        stats.bytes = static_cast<std::size_t>(std::max(std::int64_t{0}, bytes_.load()));
        stats.skipped_count = skipped_count_;
        stats.primitive_count = geometry_.primitive_count() - skipped_count_;
        return stats;
    }

  private:
    static void note_error(void* self, RTCError code, const char* message) {
        auto& intersector = *static_cast<EmbreeIntersector*>(self);
        if (intersector.error_ == RTC_ERROR_NONE) {
            intersector.error_ = code;
            intersector.message_ = message != nullptr ? message : "unknown error";
        }
    }
    static bool note_memory(void* self, ssize_t bytes, bool /*post*/) {
        static_cast<EmbreeIntersector*>(self)->bytes_ += bytes;
        return true;
    }
    void throw_on_error() const {
        if (error_ == RTC_ERROR_OUT_OF_MEMORY)
            throw std::bad_alloc();
        if (error_ != RTC_ERROR_NONE)
            throw std::runtime_error("embree: " + message_);
    }

    void attach(const Geometry& geometry, std::uint32_t id) {
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometryByID(scene_.get(), geometry.get(), id);
        throw_on_error();
    }

    void attach_mesh(std::uint32_t id) {
        const MeshView& mesh = geometry_.meshes[id];
        if (mesh.triangles.empty())
            return;
        const Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
        // Vertices are copied: Embree reads 16 bytes at each, four past the end of the last one.
        void* vertices =
            rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    sizeof(Vec3), mesh.positions.size());
        throw_on_error();
        // Embree leaves out triangles with a vertex that is not finite.
        const Vec3 untraceable{infinity, infinity, infinity};
        std::transform(mesh.positions.begin(), mesh.positions.end(), static_cast<Vec3*>(vertices),
                       [&](const Vec3& p) { return is_finite(p) ? p : untraceable; });
        rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   mesh.triangles.data(), 0, sizeof(Triangle),
                                   mesh.triangles.size());
        attach(geometry, id);
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
            note_triangle(id, i);
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

    void attach_spheres() {
        const std::uint32_t id = geometry_.sphere_geometry();
        const auto count = static_cast<std::uint32_t>(geometry_.spheres.size());
        if (count == 0)
            return;
        const Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
        rtcSetGeometryUserPrimitiveCount(geometry.get(), count);
        rtcSetGeometryUserData(geometry.get(), &geometry_);
        rtcSetGeometryBoundsFunction(geometry.get(), bound_sphere, nullptr);
        rtcSetGeometryIntersectFunction(geometry.get(), intersect_spheres);
        rtcSetGeometryOccludedFunction(geometry.get(), occlude_spheres);
        attach(geometry, id);
        for (std::uint32_t i = 0; i < count; ++i)
            skipped_count_ += is_traceable(geometry_, id, i) ? 0u : 1u;
    }

    GeometryView geometry_;
    std::atomic<std::int64_t> bytes_{0};
    RTCError error_ = RTC_ERROR_NONE;
    std::string message_;
    std::size_t skipped_count_ = 0;
    bool extreme_ = false; ///< coordinates at which Embree's products may overflow or vanish
    double build_s_ = 0;
    // Last, so that they are released while the callbacks' targets still exist.
    Device device_;
    Scene scene_;
};

} // namespace

std::unique_ptr<Intersector> make_embree_intersector(const GeometryView& geometry,
                                                     const BuildOptions& options) {
    if (options.triangle_test != TriangleTest::watertight)
        throw std::runtime_error("embree has its own watertight triangle test: "
                                 "Möller-Trumbore needs the naive or the sah structure");
    return std::make_unique<EmbreeIntersector>(geometry);
}

} // namespace plumb
