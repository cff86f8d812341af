/// \file  From scene text to rendered image, by the very steps of the program.
#pragma once

#include "renderer/integrate/render.h"
#include "renderer/io/load_scene.h"
#include "renderer/scene/scene_tables.h"

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace plumb::test {

/// What a run of the program would say on its command line.
struct RenderSetup {
    AccelKind accel = AccelKind::sah;
    BuildOptions build;
    int threads = 1;
    bool variance = false;
    bool full_profile = false;
    bool ray_by_ray = false;
    StopSettings stop;
    std::vector<std::pair<std::string, std::string>> parameters; ///< -D name=value
    std::function<void(Scene&)> adjust; ///< puts options over the scene's own settings
};

struct Rendered {
    Image image; ///< with Image::variance if RenderSetup::variance
    RenderStats stats;
};

/// A scene loaded and built: for tests that render it by parts. Throws what load_scene throws.
class LoadedScene {
  public:
    LoadedScene(const std::filesystem::path& file, const RenderSetup& setup);

    [[nodiscard]] const Scene& scene() const { return scene_; }
    [[nodiscard]] const Intersector& intersector() const { return *intersector_; }
    [[nodiscard]] Features features() const { return features_of(scene_); }
    [[nodiscard]] RenderJob job() const { return make_job(scene_, tables_.view()); }
    /// What the setup says of it, without progress and cancellation.
    [[nodiscard]] const RenderOptions& options() const { return options_; }

  private:
    Scene scene_;
    SceneTables tables_;
    std::unique_ptr<Intersector> intersector_;
    RenderOptions options_;
};

/// Loads, builds, renders. Throws what load_scene throws.
[[nodiscard]] Rendered render_file(const std::filesystem::path& file, const RenderSetup& setup);

/// Mesh files beside the scene: name and content.
using SceneFileTexts = std::map<std::string, std::string>;

/// Loads the text of a scene file, from a folder of its own: ctest runs tests side by side.
[[nodiscard]] Scene load_xml(std::string_view xml, decltype(LoadOptions::parameters) parameters);

/// The same for the text of a scene file, in a folder of its own that is removed afterwards.
[[nodiscard]] Rendered render_xml(std::string_view xml, const RenderSetup& setup,
                                  const SceneFileTexts& files = {});

/// FNV-1a (64 bit) over size and bits of the pixels.
[[nodiscard]] std::uint64_t bits_of(const Image& image);
/// The same over sums, second moments and counts of a film: what resolve() has not yet rounded.
[[nodiscard]] std::uint64_t bits_of(const Film& film);

/// Mean of all pixels and the variance of that mean, each channel, from Image::variance of samples
/// that do not depend on each other. `spp`: samples in a pixel, at least 2.
struct ImageMean {
    double mean[3] = {}, variance[3] = {};
};
[[nodiscard]] ImageMean mean_of(const Image& image, double spp);

/// z of the difference of two such means, the channel with the largest |z|.
[[nodiscard]] double largest_z(const ImageMean& a, const ImageMean& b);

} // namespace plumb::test
