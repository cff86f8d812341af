#include "tools/bench_src/structure.h"

#include "tools/bench_src/cpu.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <ctime>

namespace plumb::bench {
namespace {

std::uint64_t checksum_of(const Hit& hit) {
    return std::uint64_t{std::bit_cast<std::uint32_t>(hit.t)} + hit.primitive;
}

Hit anonymous(bool found) { return found ? Hit{0, 0, 0, 0, 0, invalid_id} : Hit{}; }

std::uint64_t trace_single(const Intersector& intersector, std::span<const Ray> rays) {
    std::uint64_t sum = 0;
    for (const Ray& ray : rays)
        sum += checksum_of(intersector.closest(ray));
    return sum;
}

std::uint64_t trace_single_any(const Intersector& intersector, std::span<const Ray> rays) {
    std::uint64_t sum = 0;
    for (const Ray& ray : rays)
        sum += intersector.occluded(ray) ? 1u : 0u;
    return sum;
}

/// Calls trace(rays, first) for runs of at most stream_size rays.
template <class F> void for_streams(std::span<const Ray> rays, F&& trace) {
    for (std::size_t first = 0; first < rays.size(); first += stream_size)
        trace(rays.subspan(first, std::min(stream_size, rays.size() - first)), first);
}

std::uint64_t trace_streams(const Intersector& intersector, std::span<const Ray> rays) {
    std::array<Hit, stream_size> hits;
    std::uint64_t sum = 0;
    for_streams(rays, [&](std::span<const Ray> stream, std::size_t) {
        intersector.closest(stream, std::span(hits).first(stream.size()));
        for (std::size_t i = 0; i < stream.size(); ++i)
            sum += checksum_of(hits[i]);
    });
    return sum;
}

std::uint64_t trace_streams_any(const Intersector& intersector, std::span<const Ray> rays) {
    std::array<std::uint8_t, stream_size> found{};
    std::uint64_t sum = 0;
    for_streams(rays, [&](std::span<const Ray> stream, std::size_t) {
        intersector.occluded(stream, std::span(found).first(stream.size()));
        for (std::size_t i = 0; i < stream.size(); ++i)
            sum += found[i];
    });
    return sum;
}

} // namespace

void Structure::build() {
    own_.reset();
    embree_.reset();
    cuda_.reset();
    loaded_ = nullptr;
    if (config_.cuda) {
        cuda_ = std::make_unique<RayTracer>(config_.side, view_, *config_.cuda,
                                            config_.build.triangle_test, config_.build.threads);
        build_s_.push_back(cuda_->stats().build_s + cuda_->upload_s());
        return;
    }
    if (config_.accel == AccelKind::embree) {
        embree_ = std::make_unique<EmbreePeer>(view_, config_.embree);
        const EmbreeScene& scene = embree_->scene();
        build_s_.push_back(config_.embree.threads == 1 ? scene.commit_cpu_s() : scene.commit_s());
        return;
    }
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t cpu_start = std::clock();
    own_ = make_intersector(config_.accel, view_, config_.build);
    const double cpu_s = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
    const double wall_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    build_s_.push_back(config_.build.threads == 1 ? cpu_s : wall_s);
}

AccelStats Structure::stats() const {
    if (own_ || cuda_)
        return own_ ? own_->stats() : cuda_->stats();
    AccelStats stats;
    stats.bytes = embree_->scene().bytes();
    stats.primitive_count = view_.primitive_count();
    return stats;
}

TraversalCounts Structure::count(const RaySet& rays) const {
    if (cuda_)
        return cuda_->count(rays.rays, rays.any_hit());
    return own_ ? own_->count(rays.rays, rays.any_hit()) : TraversalCounts{};
}

Structure::Prepared Structure::prepare(const RaySet& rays, bool wide) const {
    Prepared prepared{&rays, wide, std::nullopt};
    if (embree_)
        prepared.embree.emplace(rays.rays, rays.any_hit(), wide ? 16 : 1, rays.coherent());
    return prepared;
}

/// The time is the kernel's; rays and answers cross over before and after.
Pass Structure::trace_on_cuda(const RaySet& rays, std::span<Hit> hits) const {
    if (loaded_ != &rays)
        cuda_->load(rays.rays);
    loaded_ = &rays;
    Pass pass;
    pass.cpu_s = cuda_->trace(rays.any_hit());
    if (rays.any_hit()) {
        std::vector<std::uint8_t> found(rays.rays.size());
        cuda_->fetch(found);
        std::transform(found.begin(), found.end(), hits.begin(),
                       [](std::uint8_t f) { return anonymous(f != 0); });
    } else {
        cuda_->fetch(hits);
    }
    for (const Hit& hit : hits)
        pass.checksum += rays.any_hit() ? (hit.valid() ? 1u : 0u) : checksum_of(hit);
    return pass;
}

Pass Structure::trace(const Prepared& prepared) const {
    if (cuda_) {
        std::vector<Hit> hits(prepared.rays->rays.size());
        return trace_on_cuda(*prepared.rays, hits);
    }
    const std::vector<Ray>& rays = prepared.rays->rays;
    const bool any_hit = prepared.rays->any_hit();
    Pass pass;
    const double start = thread_cpu_s();
    if (embree_)
        pass.checksum = embree_->trace(*prepared.embree);
    else if (prepared.wide)
        pass.checksum = any_hit ? trace_streams_any(*own_, rays) : trace_streams(*own_, rays);
    else
        pass.checksum = any_hit ? trace_single_any(*own_, rays) : trace_single(*own_, rays);
    pass.cpu_s = thread_cpu_s() - start;
    return pass;
}

std::uint64_t Structure::answers(const Prepared& prepared, std::span<Hit> hits) const {
    const std::span<const Ray> rays = prepared.rays->rays;
    const bool any_hit = prepared.rays->any_hit();
    if (embree_)
        return embree_->trace(*prepared.embree, hits);
    if (cuda_)
        return trace_on_cuda(*prepared.rays, hits).checksum;
    if (prepared.wide && any_hit) {
        std::vector<std::uint8_t> found(rays.size());
        for_streams(rays, [&](std::span<const Ray> stream, std::size_t first) {
            own_->occluded(stream, std::span(found).subspan(first, stream.size()));
        });
        std::transform(found.begin(), found.end(), hits.begin(),
                       [](std::uint8_t f) { return anonymous(f != 0); });
    } else if (prepared.wide) {
        for_streams(rays, [&](std::span<const Ray> stream, std::size_t first) {
            own_->closest(stream, hits.subspan(first, stream.size()));
        });
    } else {
        for (std::size_t i = 0; i < rays.size(); ++i)
            hits[i] = any_hit ? anonymous(own_->occluded(rays[i])) : own_->closest(rays[i]);
    }
    std::uint64_t sum = 0;
    for (const Hit& hit : hits)
        sum += any_hit ? (hit.valid() ? 1u : 0u) : checksum_of(hit);
    return sum;
}

} // namespace plumb::bench
