#include "tools/stability_src/edge_rays.h"

#include "accel/embree/embree_peer.h"
#include "tools/bench_src/cpu.h"
#include "tools/stability_src/alternatives/triangle_tests.h"

#include <algorithm>

namespace plumb::stability {
namespace {

/// Asks every triangle: those near the place that the ray is aimed at first.
template <class Test> class DirectProber final : public Prober {
  public:
    DirectProber(const Mesh& mesh, Test test) : mesh_(mesh), test_(test) {}

    [[nodiscard]] std::uint64_t misses(std::span<const AimedRay> rays) const override {
        return static_cast<std::uint64_t>(std::count_if(
            rays.begin(), rays.end(), [this](const AimedRay& aimed) { return !hits(aimed); }));
    }

  private:
    [[nodiscard]] bool hits(const AimedRay& aimed) const {
        const PreparedRay prepared(aimed.ray);
        const auto one = [&](std::uint32_t i) {
            const Triangle t = mesh_.triangles[i];
            return test_(aimed.ray, prepared, mesh_.positions[t.a], mesh_.positions[t.b],
                         mesh_.positions[t.c]);
        };
        const auto& near_a = mesh_.around[aimed.a];
        const auto& near_b = mesh_.around[aimed.b];
        if (std::any_of(near_a.begin(), near_a.end(), one) ||
            std::any_of(near_b.begin(), near_b.end(), one))
            return true;
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i)
            if (one(i))
                return true;
        return false;
    }

    const Mesh& mesh_;
    Test test_;
};

template <class Test> auto direct(Test test) {
    return [test](const Mesh& mesh) -> std::unique_ptr<Prober> {
        return std::make_unique<DirectProber<Test>>(mesh, test);
    };
}

/// One of the structures behind the common interface.
class TreeProber final : public Prober {
  public:
    TreeProber(const Mesh& mesh, AccelKind kind, BuildOptions options) : view_(mesh.view()) {
        options.threads = 1;
        accel_ = make_intersector(kind, GeometryView{{&view_, 1}, {}}, options);
    }
    [[nodiscard]] std::uint64_t misses(std::span<const AimedRay> rays) const override {
        return static_cast<std::uint64_t>(
            std::count_if(rays.begin(), rays.end(), [this](const AimedRay& aimed) {
                return !accel_->closest(aimed.ray).valid();
            }));
    }

  private:
    MeshView view_;
    std::unique_ptr<Intersector> accel_;
};

auto tree(AccelKind kind, BuildOptions options = {}) {
    return [kind, options](const Mesh& mesh) -> std::unique_ptr<Prober> {
        return std::make_unique<TreeProber>(mesh, kind, options);
    };
}

/// Embree without RTC_SCENE_FLAG_ROBUST, which no Intersector of ours offers.
class EmbreeDefaultProber final : public Prober {
  public:
    explicit EmbreeDefaultProber(const Mesh& mesh)
        : view_(mesh.view()),
          peer_(GeometryView{{&view_, 1}, {}}, EmbreeOptions{false, BuildQuality::medium, 1, 1}) {}
    [[nodiscard]] std::uint64_t misses(std::span<const AimedRay> aimed) const override {
        std::vector<Ray> rays(aimed.size());
        std::transform(aimed.begin(), aimed.end(), rays.begin(),
                       [](const AimedRay& a) { return a.ray; });
        std::vector<Hit> hits(rays.size());
        static_cast<void>(peer_.trace(EmbreeRays(rays, false, 1), hits));
        return static_cast<std::uint64_t>(
            std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return !hit.valid(); }));
    }

  private:
    MeshView view_;
    EmbreePeer peer_;
};

Method alternative(std::string name, std::string what) {
    return {std::move(name), std::move(what)};
}

Method sound(std::string name, std::string what, bool is_default) {
    return {std::move(name), std::move(what), is_default, 0.0};
}

} // namespace

Ray ray_to(Random& random, Vec3 origin, Point target) {
    const Vec3 d{static_cast<float>(target.x - static_cast<double>(origin.x)),
                 static_cast<float>(target.y - static_cast<double>(origin.y)),
                 static_cast<float>(target.z - static_cast<double>(origin.z))};
    return {origin, 0, random.index(2) == 0 ? d : normalize(d), infinity};
}

AimedRay ray_to_edge(Random& random, const Mesh& mesh, Vec3 origin) {
    const Mesh::Edge e = mesh.edges[random.index(mesh.edges.size())];
    const Vec3 a = mesh.positions[e.a], b = mesh.positions[e.b];
    const double s = 0.02 + 0.96 * uniform_double(random);
    const auto mix = [&](float p, float q) {
        return static_cast<double>(p) + s * (static_cast<double>(q) - static_cast<double>(p));
    };
    return {ray_to(random, origin, {mix(a.x, b.x), mix(a.y, b.y), mix(a.z, b.z)}), e.a, e.b};
}

AimedRay ray_to_vertex(Random& random, const Mesh& mesh, Vec3 origin) {
    const std::uint32_t i = mesh.vertices[random.index(mesh.vertices.size())];
    const Vec3 v = mesh.positions[i];
    return {ray_to(random, origin,
                   {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)}),
            i, i};
}

std::vector<ProbedMethod> probed_methods() {
    std::vector<ProbedMethod> methods;
    methods.push_back({alternative("moeller-trumbore-float", "Möller and Trumbore 1997 in float"),
                       direct([](const Ray& ray, const PreparedRay&, Vec3 a, Vec3 b, Vec3 c) {
                           return moeller_trumbore<float>(ray, a, b, c);
                       })});
    methods.push_back(
        {alternative("moeller-trumbore-epsilon", "the same, determinants below 1e-8 left out"),
         direct([](const Ray& ray, const PreparedRay&, Vec3 a, Vec3 b, Vec3 c) {
             return moeller_trumbore<float>(ray, a, b, c, 1e-8f);
         })});
    methods.push_back({alternative("moeller-trumbore-double", "the same in double"),
                       direct([](const Ray& ray, const PreparedRay&, Vec3 a, Vec3 b, Vec3 c) {
                           return moeller_trumbore<double>(ray, a, b, c);
                       })});
    methods.push_back(
        {alternative("watertight-contracted", "the watertight test compiled with FMA contraction"),
         direct([](const Ray&, const PreparedRay& prepared, Vec3 a, Vec3 b, Vec3 c) {
             return watertight_contracted(prepared, a, b, c);
         })});
    methods.push_back(
        {sound("watertight", "Woop, Benthin and Wald 2013, the test of this project alone", true),
         direct([](const Ray& ray, const PreparedRay& prepared, Vec3 a, Vec3 b, Vec3 c) {
             PrimitiveHit hit;
             return intersect_triangle(prepared, a, b, c, ray.tmax, hit);
         })});
    methods.push_back({sound("naive", "that test in the plain median-split tree", false),
                       tree(AccelKind::naive)});
    for (const Isa isa : bench::supported_isas())
        methods.push_back(
            {sound("sah-" + std::string(name_of(isa)),
                   "that test in the 8-wide SAH tree, this instruction set", true),
             tree(AccelKind::sah, {TriangleTest::watertight, BuildQuality::medium, isa})});
    methods.push_back({sound("sah-high", "the SAH tree with spatial splits", false),
                       tree(AccelKind::sah, {TriangleTest::watertight, BuildQuality::high})});
    methods.push_back({alternative("embree-default", "Embree without its robust flag"),
                       [](const Mesh& mesh) -> std::unique_ptr<Prober> {
                           return std::make_unique<EmbreeDefaultProber>(mesh);
                       }});
    methods.push_back({alternative("embree-robust", "Embree with it, as --accel=embree uses it"),
                       tree(AccelKind::embree)});
    return methods;
}

} // namespace plumb::stability
