#include "accel/embree/embree_scene.h"

#include "accel/embree/embree_calls.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <new>
#include <stdexcept>

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

RTCBuildQuality to_embree(BuildQuality quality) {
    switch (quality) {
    case BuildQuality::fast: return RTC_BUILD_QUALITY_LOW;
    case BuildQuality::medium: return RTC_BUILD_QUALITY_MEDIUM;
    case BuildQuality::high: break;
    }
    return RTC_BUILD_QUALITY_HIGH;
}

/// Of rtcNewDevice; the calling thread keeps its affinity.
std::string device_config(int threads) {
    return threads > 0 ? "threads=" + std::to_string(threads) + ",set_affinity=0" : "";
}

} // namespace

struct EmbreeScene::Parts {
    Parts(const GeometryView& view, const EmbreeOptions& options)
        : geometry(view), device(rtcNewDevice(device_config(options.threads).c_str())) {
        if (!device)
            throw std::runtime_error("embree: no device");
        rtcSetDeviceErrorFunction(device.get(), note_error, this);
        rtcSetDeviceMemoryMonitorFunction(device.get(), note_memory, this);
        scene.reset(rtcNewScene(device.get()));
        rtcSetSceneFlags(scene.get(), options.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
        rtcSetSceneBuildQuality(scene.get(), to_embree(options.quality));
        for (std::uint32_t mesh = 0; mesh < geometry.meshes.size(); ++mesh)
            attach_mesh(mesh, options.quality);
        attach_spheres();
        timed([&] { rtcCommitScene(scene.get()); });
        throw_on_error();
    }

    template <class F> void timed(F&& work) {
        const auto start = std::chrono::steady_clock::now();
        const std::clock_t cpu_start = std::clock();
        work();
        commit_cpu_s += static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
        commit_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }

    static void note_error(void* self, RTCError code, const char* message) {
        auto& parts = *static_cast<Parts*>(self);
        if (parts.error == RTC_ERROR_NONE) {
            parts.error = code;
            parts.message = message != nullptr ? message : "unknown error";
        }
    }
    static bool note_memory(void* self, ssize_t bytes, bool /*post*/) {
        static_cast<Parts*>(self)->bytes += bytes;
        return true;
    }
    void throw_on_error() const {
        if (error == RTC_ERROR_OUT_OF_MEMORY)
            throw std::bad_alloc();
        if (error != RTC_ERROR_NONE)
            throw std::runtime_error("embree: " + message);
    }

    void attach(const Geometry& part, std::uint32_t id) {
        timed([&] { rtcCommitGeometry(part.get()); });
        rtcAttachGeometryByID(scene.get(), part.get(), id);
        throw_on_error();
    }

    void attach_mesh(std::uint32_t id, BuildQuality quality) {
        const MeshView& mesh = geometry.meshes[id];
        if (mesh.triangles.empty())
            return;
        const Geometry part(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
        rtcSetGeometryBuildQuality(part.get(), to_embree(quality));
        // Vertices are copied: Embree reads 16 bytes at each, four past the end of the last one.
        void* vertices =
            rtcSetNewGeometryBuffer(part.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    sizeof(Vec3), mesh.positions.size());
        throw_on_error();
        // Embree leaves out triangles with a vertex that is not finite.
        const Vec3 untraceable{infinity, infinity, infinity};
        std::transform(mesh.positions.begin(), mesh.positions.end(), static_cast<Vec3*>(vertices),
                       [&](const Vec3& p) { return is_finite(p) ? p : untraceable; });
        rtcSetSharedGeometryBuffer(part.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   mesh.triangles.data(), 0, sizeof(Triangle),
                                   mesh.triangles.size());
        attach(part, id);
    }

    void attach_spheres() {
        const auto count = static_cast<std::uint32_t>(geometry.spheres.size());
        if (count == 0)
            return;
        const Geometry part(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER));
        rtcSetGeometryUserPrimitiveCount(part.get(), count);
        rtcSetGeometryUserData(part.get(), &geometry);
        rtcSetGeometryBoundsFunction(part.get(), bound_sphere, nullptr);
        rtcSetGeometryIntersectFunction(part.get(), intersect_spheres);
        rtcSetGeometryOccludedFunction(part.get(), occlude_spheres);
        attach(part, geometry.sphere_geometry());
    }

    GeometryView geometry;
    std::atomic<std::int64_t> bytes{0};
    RTCError error = RTC_ERROR_NONE;
    std::string message;
    double commit_s = 0, commit_cpu_s = 0;
    // Last, so that they are released while the callbacks' targets still exist.
    Device device;
    Scene scene;
};

EmbreeScene::EmbreeScene(const GeometryView& geometry, const EmbreeOptions& options)
    : parts_(std::make_unique<Parts>(geometry, options)) {}
EmbreeScene::~EmbreeScene() = default;

void* EmbreeScene::handle() const { return parts_->scene.get(); }
double EmbreeScene::commit_s() const { return parts_->commit_s; }
double EmbreeScene::commit_cpu_s() const { return parts_->commit_cpu_s; }
std::size_t EmbreeScene::bytes() const {
    return static_cast<std::size_t>(std::max(std::int64_t{0}, parts_->bytes.load()));
}

std::string embree_version() { return RTC_VERSION_STRING; }

} // namespace plumb
