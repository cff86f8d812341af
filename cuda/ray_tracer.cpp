#include "cuda/ray_tracer.h"

#include "cuda/device_rays.h"
#include "cuda/host_executor.h"
#include "cuda/ray_kernel.h"

#include <chrono>
#include <mutex>
#include <variant>

namespace plumb {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Counts what a traversal touches.
struct Tally {
    TraversalCounts counts;
    void node(std::uint32_t /*index*/) { ++counts.nodes; }
    void leaf(ChildRef leaf) { counts.triangles += leaf.count(); }
    void primitive(std::uint32_t /*index*/) { ++counts.triangles; }
};

/// The kernel's body in a loop: what DeviceRays does, on the host.
class HostRays {
  public:
    HostRays(const TreeViews& trees, CudaTree tree, TriangleTest test)
        : block_(placed_size({}, trees)), tree_(tree), test_(test) {
        Arena arena = block_.arena();
        job_.trees = place(trees, arena);
    }

    void load(std::span<const Ray> rays) {
        rays_.assign(rays.begin(), rays.end());
        hits_.resize(rays.size());
        found_.resize(rays.size());
        job_.rays = rays_.data();
        job_.count = rays.size();
        job_.hits = hits_.data();
        job_.found = found_.data();
    }
    double trace(bool any_hit, RayThreads threads) {
        // A ray that is lost must not find the answer of the last trace.
        std::ranges::fill(hits_, Hit{-1, 0, 0, 0, 0, 0});
        std::ranges::fill(found_, std::uint8_t{0xff});
        const auto start = Clock::now();
        if (threads == RayThreads::persistent)
            test_ == TriangleTest::watertight ? persistently<TriangleTest::watertight>()
                                              : persistently<TriangleTest::moeller_trumbore>();
        else if (test_ == TriangleTest::watertight)
            any_hit ? with<TriangleTest::watertight, true>()
                    : with<TriangleTest::watertight, false>();
        else
            any_hit ? with<TriangleTest::moeller_trumbore, true>()
                    : with<TriangleTest::moeller_trumbore, false>();
        return seconds_since(start);
    }
    void fetch(std::span<Hit> hits) const { std::copy_n(hits_.begin(), hits.size(), hits.begin()); }
    void fetch(std::span<std::uint8_t> found) const {
        std::copy_n(found_.begin(), found.size(), found.begin());
    }
    [[nodiscard]] std::vector<KernelReport> kernels(bool /*any_hit*/,
                                                    RayThreads /*threads*/) const {
        return {};
    }

  private:
    template <TriangleTest Test> void persistently() {
        std::uint32_t taken = 0;
        trace_persistently_on_host<Test>(job_.trees.wide, RayItems{job_}, taken);
    }
    template <TriangleTest Test, bool AnyHit> void with() {
        run_grid_on_host(HostGrid{}, job_.count, [&](GridPosition at) {
            if (tree_ == CudaTree::binary)
                trace_ray_thread<Test, CudaTree::binary, AnyHit>(job_, at);
            else
                trace_ray_thread<Test, CudaTree::wide, AnyHit>(job_, at);
        });
    }

    HostBlock block_;
    CudaTree tree_;
    TriangleTest test_;
    RayJob job_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::vector<std::uint8_t> found_;
};

} // namespace

struct RayTracer::Side {
    std::variant<HostRays, DeviceRays> rays;

    template <class Rays>
    Side(std::in_place_type_t<Rays> which, const TreeViews& trees, CudaTree tree, TriangleTest test)
        : rays(which, trees, tree, test) {}
};

RayTracer::RayTracer(RaySide side, const GeometryView& geometry, CudaTree tree, TriangleTest test,
                     int threads) {
    if (tree == CudaTree::binary) {
        binary_ = build_sah(geometry, threads);
        trees_.binary = binary_.view();
        stats_ = binary_.stats();
    } else {
        wide_ = build_compressed(geometry, threads);
        trees_.wide = wide_.view();
        stats_ = wide_.stats();
    }
    const auto start = Clock::now();
    if (side == RaySide::device)
        side_ = std::make_unique<Side>(std::in_place_type<DeviceRays>, trees_, tree, test);
    else
        side_ = std::make_unique<Side>(std::in_place_type<HostRays>, trees_, tree, test);
    upload_s_ = seconds_since(start);
}

RayTracer::~RayTracer() = default;

TraversalCounts RayTracer::count(std::span<const Ray> rays, bool any_hit) const {
    Tally tally;
    const auto trace = [&](const auto& tree) {
        constexpr TriangleTest test = TriangleTest::watertight;
        for (const Ray& ray : rays)
            if (any_hit)
                static_cast<void>(plumb::occluded<test>(tree, ray, tally));
            else
                static_cast<void>(plumb::closest<test>(tree, ray, tally));
    };
    if (trees_.binary.node_count > 0)
        trace(trees_.binary);
    else
        trace(trees_.wide);
    return tally.counts;
}

void RayTracer::load(std::span<const Ray> rays) {
    std::visit([rays](auto& side) { side.load(rays); }, side_->rays);
}
double RayTracer::trace(bool any_hit, RayThreads threads) {
    return std::visit([=](auto& side) { return side.trace(any_hit, threads); }, side_->rays);
}
void RayTracer::fetch(std::span<Hit> hits) const {
    std::visit([hits](const auto& side) { side.fetch(hits); }, side_->rays);
}
void RayTracer::fetch(std::span<std::uint8_t> found) const {
    std::visit([found](const auto& side) { side.fetch(found); }, side_->rays);
}
std::vector<KernelReport> RayTracer::kernels(bool any_hit, RayThreads threads) const {
    return std::visit([=](const auto& side) { return side.kernels(any_hit, threads); },
                      side_->rays);
}

struct CudaIntersector::Locked {
    std::mutex mutex;
    RayTracer tracer;

    template <class Answer>
    void trace(std::span<const Ray> rays, bool any_hit, std::span<Answer> answers) {
        if (rays.empty())
            return;
        const std::scoped_lock lock(mutex);
        tracer.load(rays);
        tracer.trace(any_hit);
        tracer.fetch(answers);
    }
};

CudaIntersector::CudaIntersector(RaySide side, const GeometryView& geometry, CudaTree tree,
                                 TriangleTest test, int threads)
    : locked_(new Locked{{}, {side, geometry, tree, test, threads}}) {}

CudaIntersector::~CudaIntersector() = default;

Hit CudaIntersector::closest(const Ray& ray) const {
    Hit hit;
    closest({&ray, 1}, {&hit, 1});
    return hit;
}

bool CudaIntersector::occluded(const Ray& ray) const {
    std::uint8_t found = 0;
    occluded({&ray, 1}, {&found, 1});
    return found != 0;
}

void CudaIntersector::closest(std::span<const Ray> rays, std::span<Hit> hits) const {
    locked_->trace(rays, false, hits);
}

void CudaIntersector::occluded(std::span<const Ray> rays, std::span<std::uint8_t> found) const {
    locked_->trace(rays, true, found);
}

TraversalCounts CudaIntersector::count(std::span<const Ray> rays, bool any_hit) const {
    return locked_->tracer.count(rays, any_hit);
}

AccelStats CudaIntersector::stats() const { return locked_->tracer.stats(); }

} // namespace plumb
