#include "cuda/validate_paths.h"

#include <bit>
#include <chrono>
#include <cstdio>
#include <vector>

namespace plumb {
namespace {

constexpr std::size_t batch_rays = 1u << 16; ///< enough to keep a device busy

bool same_bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

bool same_hit(const Hit& a, const Hit& b) {
    return same_bits(a.t, b.t) && same_bits(a.u, b.u) && same_bits(a.v, b.v) &&
           a.geometry == b.geometry && a.primitive == b.primitive && a.instance == b.instance;
}

/// Rays of paths and what the CPU answered, in the order in which they came.
class Recorder {
  public:
    Recorder(const Intersector& cpu, const Intersector& device, PathValidation& found)
        : cpu_(cpu), device_(device), found_(found) {}

    void begin_path(int x, int y, std::uint32_t sample) {
        path_ = {x, y, sample, -1, false, {}, {}, {}};
    }
    [[nodiscard]] Hit closest(const Ray& ray) {
        const Hit hit = cpu_.closest(ray);
        ++path_.bounce;
        rays_.push_back(ray);
        keep(ray, false).cpu = hit;
        return hit;
    }
    [[nodiscard]] bool occluded(const Ray& ray) {
        const bool found = cpu_.occluded(ray);
        shadows_.push_back(ray);
        keep(ray, true);
        blocked_.push_back(found ? 1 : 0);
        return found;
    }
    [[nodiscard]] bool full() const { return entries_.size() >= batch_rays; }

    /// Has the device answer, compares, and begins anew.
    void compare() {
        std::vector<Hit> hits(rays_.size());
        std::vector<std::uint8_t> blocked(shadows_.size());
        device_.closest(rays_, hits);
        device_.occluded(shadows_, blocked);
        std::size_t next_hit = 0, next_shadow = 0;
        for (PathDifference& entry : entries_) {
            RayCounts one;
            ++(entry.shadow ? one.shadow : entry.bounce == 0 ? one.camera : one.bounce);
            found_.rays += one;
            bool same = false;
            if (entry.shadow) {
                same = blocked[next_shadow] == blocked_[next_shadow];
                ++next_shadow;
            } else {
                entry.device = hits[next_hit++];
                same = same_hit(entry.cpu, entry.device);
            }
            if (same)
                continue;
            found_.different += one;
            if (!found_.first)
                found_.first = with_hits(entry);
        }
        rays_.clear();
        shadows_.clear();
        blocked_.clear();
        entries_.clear();
    }

  private:
    PathDifference& keep(const Ray& ray, bool shadow) {
        PathDifference& entry = entries_.emplace_back(path_);
        entry.ray = ray;
        entry.shadow = shadow;
        return entry;
    }
    [[nodiscard]] PathDifference with_hits(PathDifference entry) const {
        if (entry.shadow) {
            entry.cpu = cpu_.closest(entry.ray);
            entry.device = device_.closest(entry.ray);
        }
        return entry;
    }

    const Intersector &cpu_, &device_;
    PathValidation& found_;
    PathDifference path_;
    std::vector<PathDifference> entries_;
    std::vector<Ray> rays_, shadows_;
    std::vector<std::uint8_t> blocked_;
};

/// The query that sample_pixel sees.
struct RecorderQuery {
    Recorder& recorder;

    [[nodiscard]] Hit closest(const Ray& ray) const { return recorder.closest(ray); }
    [[nodiscard]] bool occluded(const Ray& ray) const { return recorder.occluded(ray); }
};

template <Features F>
void render_rows(const RenderJob& job, Recorder& recorder, const RenderOptions& options, Film& film,
                 RenderStats& stats) {
    const Crop& crop = job.crop;
    const RecorderQuery query{recorder};
    for (int y = crop.y; y < crop.y + crop.height; ++y) {
        for (int x = crop.x; x < crop.x + crop.width; ++x)
            for (std::uint32_t s = 0; s < job.sampler.spp; ++s) {
                recorder.begin_path(x, y, s);
                film.pixel(x, y).add(sample_pixel<F>(job, query, x, y, s, stats.rays),
                                     options.variance);
                if (recorder.full())
                    recorder.compare();
            }
        if (options.progress)
            options.progress(
                {static_cast<double>(y + 1 - crop.y) / crop.height, stats.rays.total()});
        if (options.cancel != nullptr && options.cancel->load(std::memory_order_relaxed)) {
            stats.stopped_by = StoppedBy::signal;
            return;
        }
    }
}

std::string answer(const PathDifference& d, const Hit& hit) {
    char text[96];
    if (!hit.valid())
        return d.shadow ? "free" : "a miss";
    std::snprintf(text, sizeof(text), "%s%u:%u at t %.9g, u %.9g, v %.9g",
                  d.shadow ? "blocked by " : "", hit.geometry, hit.primitive,
                  static_cast<double>(hit.t), static_cast<double>(hit.u),
                  static_cast<double>(hit.v));
    return text;
}

} // namespace

Film validate_paths(const RenderJob& job, const Features& needed, const Intersector& cpu,
                    const Intersector& device, const RenderOptions& options, RenderStats& stats,
                    PathValidation& found) {
    const auto start = std::chrono::steady_clock::now();
    Film film(job.width, job.height, job.crop, options.variance);
    Recorder recorder(cpu, device, found);
    const bool box = box_profile.covers(needed) && !options.force_full_profile;
    stats.profile = profile_name(box ? box_profile : full_profile);
    (box ? render_rows<box_profile> : render_rows<full_profile>)(job, recorder, options, film,
                                                                 stats);
    recorder.compare();
    stats.samples = stats.rays.camera;
    stats.render_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return film;
}

std::string text_of(const PathValidation& found, std::string_view cpu) {
    const auto number = [](std::uint64_t n) { return std::to_string(n); };
    const RayCounts &all = found.rays, &other = found.different;
    std::string out = "validation of " + std::string(cpu) +
                      " against cuda: " + number(all.total()) + " rays: " + number(all.camera) +
                      " camera, " + number(all.bounce) + " bounce, " + number(all.shadow) +
                      " shadow\n";
    out += "  of other bits: " + number(other.camera) + " camera, " + number(other.bounce) +
           " bounce, " + number(other.shadow) + " shadow\n";
    if (!found.first)
        return out;
    const PathDifference& d = *found.first;
    char text[320];
    std::snprintf(text, sizeof(text),
                  "  first: pixel (%d, %d), sample %u, bounce %d, %s ray\n"
                  "    origin (%.9g %.9g %.9g) direction (%.9g %.9g %.9g) t %.9g to %.9g\n",
                  d.x, d.y, d.sample, d.bounce,
                  d.shadow        ? "shadow"
                  : d.bounce == 0 ? "camera"
                                  : "bounce",
                  static_cast<double>(d.ray.origin.x), static_cast<double>(d.ray.origin.y),
                  static_cast<double>(d.ray.origin.z), static_cast<double>(d.ray.direction.x),
                  static_cast<double>(d.ray.direction.y), static_cast<double>(d.ray.direction.z),
                  static_cast<double>(d.ray.tmin), static_cast<double>(d.ray.tmax));
    return out + text + "    " + std::string(cpu) + ": " + answer(d, d.cpu) +
           "; cuda: " + answer(d, d.device) + "\n";
}

} // namespace plumb
