/// \file  What --validate=cuda finds: nothing where the bits are the same, else the first bounce.

#include "cuda/ray_tracer.h"
#include "cuda/validate_paths.h"
#include "tests/support/box_scenes.h"
#include "tests/support/render_scene.h"

#include "renderer/scene/image_hash.h"
#include "renderer/scene/scene_tables.h"

#include <gtest/gtest.h>

namespace plumb::test {
namespace {

Scene rich_scene() { return load_xml(rich_box(), {{"side", "17"}, {"spp", "3"}}); }

/// Answers as another does, apart from the n-th ray of one kind.
class Liar final : public Intersector {
  public:
    Liar(const Intersector& honest, bool about_shadows, std::size_t nth)
        : honest_(honest), about_shadows_(about_shadows), nth_(nth) {}
    [[nodiscard]] Hit closest(const Ray& ray) const override { return honest_.closest(ray); }
    [[nodiscard]] bool occluded(const Ray& ray) const override { return honest_.occluded(ray); }
    void closest(std::span<const Ray> rays, std::span<Hit> hits) const override {
        honest_.closest(rays, hits);
        if (!about_shadows_ && nth_ < rays.size())
            hits[nth_].t = std::nextafter(hits[nth_].t, 0.0f);
    }
    void occluded(std::span<const Ray> rays, std::span<std::uint8_t> found) const override {
        honest_.occluded(rays, found);
        if (about_shadows_ && nth_ < rays.size())
            found[nth_] ^= 1;
    }
    [[nodiscard]] AccelStats stats() const override { return honest_.stats(); }

  private:
    const Intersector& honest_;
    bool about_shadows_;
    std::size_t nth_;
};

class ValidatePaths : public ::testing::Test {
  protected:
    Film validate(const Intersector& device, PathValidation& found) {
        RenderStats stats;
        Film film = validate_paths(job, needed, *sah, device, {}, stats, found);
        EXPECT_EQ(found.rays.total(), stats.rays.total());
        return film;
    }

    Scene scene = rich_scene();
    SceneTables tables{scene};
    RenderJob job = make_job(scene, tables.view());
    Features needed = features_of(scene);
    std::unique_ptr<Intersector> sah = make_intersector(AccelKind::sah, tables.geometry());
};

TEST_F(ValidatePaths, FindsNothingBetweenTheCpuAndTheKernelsOnTheHost) {
    for (const CudaTree tree : {CudaTree::binary, CudaTree::wide}) {
        const CudaIntersector kernels(RaySide::host, tables.geometry(), tree,
                                      TriangleTest::watertight);
        PathValidation found;
        const Film film = validate(kernels, found);
        EXPECT_EQ(found.different.total(), 0u);
        EXPECT_FALSE(found.first);
        EXPECT_GT(found.rays.shadow, 100u);
        EXPECT_NE(text_of(found, "sah").find("of other bits: 0 camera, 0 bounce, 0 shadow"),
                  std::string::npos);
        RenderStats stats;
        const Film plain = render(job, needed, *sah, {}, stats);
        EXPECT_EQ(hash_of(film.resolve()), hash_of(plain.resolve()));
    }
}

TEST_F(ValidatePaths, NamesTheFirstBounceThatDiffersInOneBit) {
    for (const std::size_t nth : {0u, 1u, 2u, 300u}) {
        const Liar liar(*sah, false, nth);
        PathValidation found;
        static_cast<void>(validate(liar, found));
        ASSERT_TRUE(found.first) << nth;
        EXPECT_EQ(found.different.total(), 1u);
        // The rays of a path come one after the other: the n-th closest-hit ray of the render.
        std::size_t passed = 0;
        struct Counter {
            const Intersector& cpu;
            std::size_t& rays;
            Hit closest(const Ray& ray) const {
                ++rays;
                return cpu.closest(ray);
            }
            bool occluded(const Ray& ray) const { return cpu.occluded(ray); }
        };
        std::size_t before = 0;
        int x = job.crop.x, y = job.crop.y;
        std::uint32_t sample = 0;
        for (;;) { // the path that holds it
            before = passed;
            RayCounts counts;
            static_cast<void>(
                sample_pixel<full_profile>(job, Counter{*sah, passed}, x, y, sample, counts));
            if (passed > nth)
                break;
            if (++sample == job.sampler.spp) {
                sample = 0;
                if (++x == job.crop.x + job.crop.width) {
                    x = job.crop.x;
                    ++y;
                }
            }
        }
        EXPECT_EQ(found.first->x, x);
        EXPECT_EQ(found.first->y, y);
        EXPECT_EQ(found.first->sample, sample);
        EXPECT_EQ(found.first->bounce, static_cast<int>(nth - before));
        EXPECT_NE(text_of(found, "sah").find("first: pixel ("), std::string::npos);
    }
}

TEST_F(ValidatePaths, NamesAShadowRayThatDiffers) {
    const Liar liar(*sah, true, 7);
    PathValidation found;
    static_cast<void>(validate(liar, found));
    ASSERT_TRUE(found.first);
    EXPECT_TRUE(found.first->shadow);
    EXPECT_EQ(found.different.shadow, 1u);
    EXPECT_EQ(found.different.total(), 1u);
    EXPECT_NE(text_of(found, "sah").find("shadow ray"), std::string::npos);
}

} // namespace
} // namespace plumb::test
