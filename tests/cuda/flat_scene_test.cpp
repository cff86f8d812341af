/// \file  A scene as one file: what is read is what was written, and damage is refused.

#include "cuda/flat_scene.h"
#include "tests/support/box_scenes.h"
#include "tests/support/render_scene.h"

#include "renderer/scene/image_hash.h"
#include "renderer/scene/scene_tables.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

#include <unistd.h>

namespace plumb::test {
namespace {

Scene rich_scene() { return load_xml(rich_box(), {{"side", "15"}, {"spp", "3"}}); }

FlatScene rich_flat() {
    const Scene scene = rich_scene();
    const SceneTables tables(scene);
    return flatten("rich", make_job(scene, tables.view()), features_of(scene));
}

/// Hash of the image that the CPU renders of a job.
std::uint64_t rendered(const RenderJob& job, const Features& needed) {
    const auto naive = make_intersector(AccelKind::naive, job.scene.geometry);
    RenderStats stats;
    return hash_of(render(job, needed, *naive, {}, stats).resolve());
}

TEST(FlatScene, RendersTheSameBitsAfterAWayThroughAFile) {
    const Scene scene = rich_scene();
    const SceneTables tables(scene);
    const RenderJob job = make_job(scene, tables.view());
    FlatScene flat = flatten("rich", job, features_of(scene));
    flat.image_hash = rendered(job, features_of(scene));
    flat.rays = {1, 2, 3};
    const auto file = std::filesystem::path(::testing::TempDir()) /
                      ("plumb_" + std::to_string(::getpid()) + ".flat");
    write_flat(file, flat);
    const FlatScene read = read_flat(file);
    std::filesystem::remove(file);
    EXPECT_EQ(read.name, "rich");
    EXPECT_EQ(read.rays.shadow, 3u);
    EXPECT_EQ(read.needed, features_of(scene));
    ASSERT_EQ(read.image_hash, flat.image_hash);
    const FlatJob again(read);
    EXPECT_EQ(rendered(again.job(), read.needed), flat.image_hash);
}

TEST(FlatScene, EveryCutIsRefused) {
    const std::string bytes = to_bytes(rich_flat());
    ASSERT_NO_THROW(static_cast<void>(from_bytes(bytes)));
    for (std::size_t length = 0; length < bytes.size(); length += length < 300 ? 1 : 97)
        EXPECT_THROW(static_cast<void>(from_bytes({bytes.data(), length})), std::runtime_error)
            << length;
    EXPECT_THROW(static_cast<void>(from_bytes(bytes + "x")), std::runtime_error);
}

std::string complaint(const FlatScene& scene) {
    try {
        static_cast<void>(from_bytes(to_bytes(scene)));
        return "";
    } catch (const std::runtime_error& error) {
        return error.what();
    }
}

TEST(FlatScene, IndicesThatLeadOutsideAreRefused) {
    const FlatScene whole = rich_flat();
    ASSERT_EQ(complaint(whole), "");
    const std::string expected = "the scene contradicts itself";
    FlatScene flat = whole;
    flat.meshes[0].triangles[0].b = 1000;
    EXPECT_EQ(complaint(flat), expected);
    flat = whole;
    flat.surfaces[0].front = 99;
    EXPECT_EQ(complaint(flat), expected);
    flat = whole;
    flat.surfaces.pop_back();
    EXPECT_EQ(complaint(flat), expected);
    flat = whole;
    flat.light_cdf.pop_back();
    EXPECT_EQ(complaint(flat), expected);
    flat = whole;
    flat.settings.crop.width = 0;
    EXPECT_EQ(complaint(flat), expected);
}

TEST(FlatScene, AFileThatIsNotThereIsNamed) {
    try {
        static_cast<void>(read_flat("/no/such/file.flat"));
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_EQ(std::string(error.what()), "/no/such/file.flat: cannot be opened");
    }
}

} // namespace
} // namespace plumb::test
