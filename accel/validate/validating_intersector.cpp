#include "accel/validate/validating_intersector.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <mutex>
#include <thread>

namespace plumb {
namespace {

constexpr std::size_t shard_count = 64;
using Counter = std::atomic<std::uint64_t>;

void add_one(Counter& counter) { counter.fetch_add(1, std::memory_order_relaxed); }

template <class Value> void raise(std::atomic<Value>& largest, Value value) {
    Value before = largest.load(std::memory_order_relaxed);
    while (before < value && !largest.compare_exchange_weak(before, value)) {
    }
}

std::size_t ulp_bin(std::uint64_t ulps) {
    return ulps <= 2 ? ulps : ulps <= 4 ? 3 : ulps <= 8 ? 4 : 5;
}

/// Difference of two barycentrics in ulps of 1.
std::uint64_t ulps_of_one(float a, float b) {
    const double ulps = std::fabs(static_cast<double>(a) - static_cast<double>(b)) * 0x1p23;
    return ulps < 1e18 ? static_cast<std::uint64_t>(std::ceil(ulps)) : ~std::uint64_t{0};
}

/// FNV-1a over a ray's bits and the query.
std::uint64_t hash_of(const Ray& ray, bool any_hit) {
    std::uint64_t hash = any_hit ? 0x84222325cbf29ce4u : 0xcbf29ce484222325u;
    for (const float value : {ray.origin.x, ray.origin.y, ray.origin.z, ray.tmin, ray.direction.x,
                              ray.direction.y, ray.direction.z, ray.tmax})
        hash = (hash ^ std::bit_cast<std::uint32_t>(value)) * 0x100000001b3u;
    return (hash ^ (hash >> 32u)) * 0x9e3779b97f4a7c15u;
}

} // namespace

std::string_view name_of(RayKind kind) {
    switch (kind) {
    case RayKind::camera: return "camera";
    case RayKind::bounce: return "bounce";
    case RayKind::shadow: return "shadow";
    }
    return "unknown";
}

/// The counters of some of the threads.
struct alignas(64) ValidatingIntersector::Shard {
    std::array<Counter, ray_kind_count> rays{};
    std::array<std::array<Counter, 4>, agreement_count> counts{};
    std::array<Counter, 6> t_ulps{}, uv_ulps{};
    Counter worst_t_ulps{0}, worst_uv_ulps{0};
    std::atomic<double> worst_share{0};
};

/// The disagreements with the smallest hashes; those in ulps only where room is left.
struct ValidatingIntersector::Kept {
    std::mutex mutex;
    std::multimap<std::uint64_t, Disagreement> by_hash;

    void add(Disagreement disagreement, std::size_t limit) {
        if (limit == 0)
            return;
        const bool common = disagreement.verdict.agreement == Agreement::ulps;
        const std::uint64_t hash = hash_of(disagreement.ray, disagreement.answers.any_hit) >> 1u |
                                   (common ? std::uint64_t{1} << 63u : 0);
        const std::scoped_lock lock(mutex);
        if (by_hash.size() >= limit && hash >= by_hash.rbegin()->first)
            return;
        by_hash.emplace(hash, std::move(disagreement));
        if (by_hash.size() > limit)
            by_hash.erase(std::prev(by_hash.end()));
    }
    [[nodiscard]] std::vector<Disagreement> list() const {
        std::vector<Disagreement> all;
        for (const auto& [hash, disagreement] : by_hash)
            all.push_back(disagreement);
        return all;
    }
};

std::uint64_t ValidationReport::ray_count() const { return rays[0] + rays[1] + rays[2]; }

std::uint64_t ValidationReport::count(Agreement agreement) const {
    std::uint64_t sum = 0;
    for (const std::uint64_t n : counts[static_cast<std::size_t>(agreement)])
        sum += n;
    return sum;
}

std::uint64_t ValidationReport::unexplained_count() const {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < agreement_count; ++i)
        if (!is_explained(static_cast<Agreement>(i)))
            sum += count(static_cast<Agreement>(i));
    return sum;
}

ValidatingIntersector::ValidatingIntersector(GeometryView geometry, const Intersector& first,
                                             const Intersector& second, ValidationOptions options)
    : first_(first), second_(second), options_(std::move(options)),
      classifier_(geometry, first, second), shards_(std::make_unique<Shard[]>(shard_count)),
      unexplained_(std::make_unique<Kept>()), explained_(std::make_unique<Kept>()) {}

ValidatingIntersector::~ValidatingIntersector() = default;

Hit ValidatingIntersector::closest(const Ray& ray) const {
    const Hit hit = first_.closest(ray);
    compare_closest(ray, hit, second_.closest(ray));
    return hit;
}

bool ValidatingIntersector::occluded(const Ray& ray) const {
    const bool found = first_.occluded(ray);
    compare_occluded(ray, found, second_.occluded(ray));
    return found;
}

void ValidatingIntersector::closest(std::span<const Ray> rays, std::span<Hit> hits) const {
    std::vector<Hit> others(rays.size());
    first_.closest(rays, hits);
    second_.closest(rays, others);
    for (std::size_t i = 0; i < rays.size(); ++i)
        compare_closest(rays[i], hits[i], others[i]);
}

void ValidatingIntersector::occluded(std::span<const Ray> rays,
                                     std::span<std::uint8_t> found) const {
    std::vector<std::uint8_t> others(rays.size());
    first_.occluded(rays, found);
    second_.occluded(rays, others);
    for (std::size_t i = 0; i < rays.size(); ++i)
        compare_occluded(rays[i], found[i] != 0, others[i] != 0);
}

TraversalCounts ValidatingIntersector::count(std::span<const Ray> rays, bool any_hit) const {
    return first_.count(rays, any_hit);
}

AccelStats ValidatingIntersector::stats() const { return first_.stats(); }

ValidatingIntersector::Shard& ValidatingIntersector::shard() const {
    return shards_[std::hash<std::thread::id>{}(std::this_thread::get_id()) % shard_count];
}

void ValidatingIntersector::compare_closest(const Ray& ray, const Hit& first,
                                            const Hit& second) const {
    const bool camera = options_.is_camera_ray && options_.is_camera_ray(ray);
    const Verdict verdict = classifier_.closest(ray, first, second);
    note(ray, camera ? RayKind::camera : RayKind::bounce, verdict, {first, second});
}

void ValidatingIntersector::compare_occluded(const Ray& ray, bool first, bool second) const {
    Answers answers{{}, {}, true, first, second};
    const Verdict verdict = classifier_.occluded(ray, answers);
    note(ray, RayKind::shadow, verdict, answers);
}

void ValidatingIntersector::note(const Ray& ray, RayKind kind, const Verdict& verdict,
                                 const Answers& answers) const {
    Shard& s = shard();
    add_one(s.rays[static_cast<std::size_t>(kind)]);
    add_one(s.counts[static_cast<std::size_t>(verdict.agreement)]
                    [static_cast<std::size_t>(verdict.culprit)]);
    if (verdict.agreement == Agreement::equal)
        return;
    bool keep = true;
    const Hit &a = answers.first, &b = answers.second;
    if (verdict.agreement == Agreement::ulps || verdict.agreement == Agreement::inexact) {
        const std::uint64_t t = ulps_between(a.t, b.t);
        const std::uint64_t uv = std::max(ulps_of_one(a.u, b.u), ulps_of_one(a.v, b.v));
        keep = t > 8 || verdict.agreement == Agreement::inexact;
        if (a.geometry == b.geometry && a.primitive == b.primitive) {
            add_one(s.t_ulps[ulp_bin(t)]);
            add_one(s.uv_ulps[ulp_bin(uv)]);
        }
        if (verdict.agreement == Agreement::ulps) {
            raise(s.worst_t_ulps, t);
            raise(s.worst_uv_ulps, uv);
            raise(s.worst_share, verdict.share_of_bound);
        }
    }
    if (!keep)
        return;
    if (is_explained(verdict.agreement))
        explained_->add({ray, kind, verdict, answers}, options_.keep_explained);
    else
        unexplained_->add({ray, kind, verdict, answers}, options_.keep_unexplained);
}

ValidationReport ValidatingIntersector::report() const {
    ValidationReport out;
    const auto add = [](const auto& from, auto& to) {
        for (std::size_t i = 0; i < to.size(); ++i)
            to[i] += from[i];
    };
    for (std::size_t i = 0; i < shard_count; ++i) {
        const Shard& s = shards_[i];
        add(s.rays, out.rays);
        for (std::size_t a = 0; a < agreement_count; ++a)
            add(s.counts[a], out.counts[a]);
        add(s.t_ulps, out.t_ulps);
        add(s.uv_ulps, out.uv_ulps);
        out.worst_t_ulps = std::max(out.worst_t_ulps, s.worst_t_ulps.load());
        out.worst_share = std::max(out.worst_share, s.worst_share.load());
        out.worst_uv_ulps = std::max(out.worst_uv_ulps, s.worst_uv_ulps.load());
    }
    out.unchecked = classifier_.unchecked();
    out.unexplained = unexplained_->list();
    out.explained = explained_->list();
    return out;
}

} // namespace plumb
