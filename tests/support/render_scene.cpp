#include "tests/support/render_scene.h"

#include <atomic>
#include <bit>
#include <cmath>
#include <fstream>

#include <unistd.h>

namespace plumb::test {
namespace {

namespace fs = std::filesystem;

/// An empty folder, removed at the end.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        static std::atomic<int> count{0};
        path_ = fs::temp_directory_path() /
                ("plumb_render_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
        fs::create_directories(path_);
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    [[nodiscard]] fs::path write(const std::string& name, std::string_view content) const {
        std::ofstream(path_ / name, std::ios::binary) << content;
        return path_ / name;
    }

  private:
    fs::path path_;
};

class Fnv {
  public:
    void add(std::uint32_t word) {
        for (int shift = 0; shift < 32; shift += 8)
            hash_ = (hash_ ^ ((word >> shift) & 0xffu)) * 0x100000001b3u;
    }
    void add(double value) {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        add(static_cast<std::uint32_t>(bits));
        add(static_cast<std::uint32_t>(bits >> 32));
    }
    [[nodiscard]] std::uint64_t value() const { return hash_; }

  private:
    std::uint64_t hash_ = 0xcbf29ce484222325u;
};

} // namespace

LoadedScene::LoadedScene(const fs::path& file, const RenderSetup& setup)
    : scene_([&] {
          Scene scene = load_scene({file, setup.parameters, false});
          if (setup.adjust)
              setup.adjust(scene);
          return scene;
      }()),
      tables_(scene_),
      intersector_(make_intersector(setup.accel, tables_.geometry(), setup.build)) {
    options_.threads = setup.threads;
    options_.variance = setup.variance;
    options_.force_full_profile = setup.full_profile;
    options_.ray_by_ray = setup.ray_by_ray;
    options_.stop = setup.stop;
}

Rendered render_file(const fs::path& file, const RenderSetup& setup) {
    const LoadedScene loaded(file, setup);
    Rendered result;
    result.image = render(loaded.job(), loaded.features(), loaded.intersector(), loaded.options(),
                          result.stats)
                       .resolve();
    return result;
}

Scene load_xml(std::string_view xml, decltype(LoadOptions::parameters) parameters) {
    const TemporaryFolder folder;
    return load_scene({folder.write("scene.xml", xml), std::move(parameters), false});
}

Rendered render_xml(std::string_view xml, const RenderSetup& setup, const SceneFileTexts& files) {
    const TemporaryFolder folder;
    for (const auto& [name, content] : files)
        static_cast<void>(folder.write(name, content));
    return render_file(folder.write("scene.xml", xml), setup);
}

std::uint64_t bits_of(const Image& image) {
    Fnv hash;
    hash.add(static_cast<std::uint32_t>(image.width));
    hash.add(static_cast<std::uint32_t>(image.height));
    for (const Rgb& p : image.pixels)
        for (const float c : {p.r, p.g, p.b})
            hash.add(std::bit_cast<std::uint32_t>(c));
    return hash.value();
}

std::uint64_t bits_of(const Film& film) {
    Fnv hash;
    for (const FilmPixel& p : film.pixels()) {
        hash.add(p.count);
        for (int c = 0; c < 3; ++c) {
            hash.add(p.sum[c]);
            hash.add(p.m2[c]);
        }
    }
    return hash.value();
}

ImageMean mean_of(const Image& image, double spp) {
    ImageMean result;
    const double n = static_cast<double>(image.pixels.size());
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const Rgb &p = image.pixels[i], &v = image.variance.at(i);
        const float values[3] = {p.r, p.g, p.b}, variances[3] = {v.r, v.g, v.b};
        for (int c = 0; c < 3; ++c) {
            result.mean[c] += static_cast<double>(values[c]) / n;
            result.variance[c] += static_cast<double>(variances[c]) / (spp * n * n);
        }
    }
    return result;
}

double largest_z(const ImageMean& a, const ImageMean& b) {
    double largest = 0;
    for (int c = 0; c < 3; ++c) {
        const double z = (a.mean[c] - b.mean[c]) / std::sqrt(a.variance[c] + b.variance[c]);
        if (!(std::fabs(z) <= std::fabs(largest))) // NaN stays
            largest = z;
    }
    return largest;
}

} // namespace plumb::test
