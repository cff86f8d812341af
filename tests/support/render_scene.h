/// \file  From scene text to rendered image, by the very steps of the program.
#pragma once

#include "renderer/integrate/render.h"
#include "renderer/io/load_scene.h"

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

/// Loads, builds, renders. Throws what load_scene throws.
[[nodiscard]] Rendered render_file(const std::filesystem::path& file, const RenderSetup& setup);

/// Mesh files beside the scene: name and content.
using SceneFileTexts = std::map<std::string, std::string>;

/// The same for the text of a scene file, in a folder of its own that is removed afterwards.
[[nodiscard]] Rendered render_xml(std::string_view xml, const RenderSetup& setup,
                                  const SceneFileTexts& files = {});

/// FNV-1a (64 bit) over size and bits of the pixels.
[[nodiscard]] std::uint64_t bits_of(const Image& image);

/// Mean of all pixels and the variance of that mean, each channel, from Image::variance of samples
/// that do not depend on each other. `spp`: samples in a pixel, at least 2.
struct ImageMean {
    double mean[3] = {}, variance[3] = {};
};
[[nodiscard]] ImageMean mean_of(const Image& image, double spp);

/// z of the difference of two such means, the channel with the largest |z|.
[[nodiscard]] double largest_z(const ImageMean& a, const ImageMean& b);

} // namespace plumb::test
