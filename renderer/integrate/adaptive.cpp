#include "renderer/integrate/adaptive.h"

#include "renderer/integrate/deadline.h"
#include "renderer/integrate/pixel_error.h"

#include <limits>

namespace plumb {
namespace {

constexpr std::uint32_t first_round = 32; // samples of a half before the first judgement
constexpr std::uint64_t other_seed = 0x9e3779b97f4a7c15u;

/// Round numbers of samples: powers of two, where Sobol' points are even, and 3/2 of them.
std::uint32_t next_round(std::uint32_t n) {
    if (n == 0)
        return first_round;
    return (n & (n - 1)) == 0 ? n / 2 * 3 : n / 3 * 4;
}

/// One of the two independent images, and its judgement of the other.
struct Half {
    Half(const RenderJob& of, std::uint64_t seed)
        : job(of), film(of.width, of.height, of.crop, true),
          error(film.pixels().size(), std::numeric_limits<float>::infinity()),
          settled(film.pixels().size(), 0) {
        job.sampler.seed = seed;
    }

    RenderJob job;
    Film film;
    double floor = 0;                  ///< of the relative error, a luminance
    std::vector<float> error;          ///< as the other half's pixels were last judged
    std::vector<std::uint8_t> settled; ///< judged by the other half: this one's estimate is final
};

class AdaptiveRender {
  public:
    AdaptiveRender(const RenderJob& job, const TileRenderer& tiles, const RenderOptions& options,
                   RenderStats& stats)
        : tiles_(tiles), options_(options), stats_(stats), crop_(job.crop),
          most_(job.sampler.spp / 2),
          deadline_(options.stop.time_limit_s), halves_{{job, job.sampler.seed},
                                                        {job, job.sampler.seed ^ other_seed}},
          active_(job.crop), result_(job.width, job.height, job.crop, true) {}

    Film run() {
        stats_.stopped_by = sample();
        for (Half& half : halves_)
            for (std::size_t p = 0; p < half.settled.size(); ++p)
                if (half.settled[p] == 0)
                    settle(half, p);
        return std::move(result_);
    }

  private:
    /// Rounds until something ends them.
    StoppedBy sample() {
        std::uint32_t n = 0;
        while (n < most_) {
            const std::uint32_t round = std::min(next_round(n), most_);
            while (n < round) {
                const double pixels = 2 * static_cast<double>(active_.count());
                const std::uint32_t end = deadline_.reachable(n, round, pixels);
                if (end == n)
                    return StoppedBy::time_limit;
                for (Half& half : halves_)
                    tiles_.render(half.job, {n, end}, &active_, half.film, stats_.rays,
                                  [&](double, std::uint64_t rays) { report(n, rays); });
                deadline_.passed();
                n = end;
                if (tiles_.cancelled())
                    return StoppedBy::signal;
            }
            judge(halves_[0], halves_[1], n);
            judge(halves_[1], halves_[0], n);
            error_ = std::max(error_of_image(halves_[0].error), error_of_image(halves_[1].error));
            if (active_.count() == 0)
                return StoppedBy::target_error;
        }
        return StoppedBy::spp;
    }

    /// Settles the pixels of `judged`, which have n samples, by what `judge` says of them.
    void judge(Half& judge, Half& judged, std::uint32_t n) {
        const double target = options_.stop.target_error;
        const std::span<const FilmPixel> pixels = judge.film.pixels();
        if (judge.floor == 0)
            judge.floor = floor_of_mean * mean_luminance(pixels);
        for (std::size_t p = 0; p < pixels.size(); ++p)
            if (judged.settled[p] == 0)
                judge.error[p] =
                    static_cast<float>(relative_error(pixels[p], 2.0 * n, judge.floor));
        const bool enough = error_of_image(judge.error) <= target;
        for (std::size_t p = 0; p < pixels.size(); ++p)
            if (judged.settled[p] == 0 && (enough || largest_around(judge.error, p) <= target))
                settle(judged, p);
    }

    /// Over a pixel and its neighbours in the crop.
    [[nodiscard]] double largest_around(const std::vector<float>& error, std::size_t pixel) const {
        const auto width = static_cast<std::size_t>(crop_.width);
        const auto height = static_cast<std::size_t>(crop_.height);
        const std::size_t x = pixel % width, y = pixel / width;
        float largest = 0;
        for (std::size_t ny = y - std::min<std::size_t>(y, 1); ny < std::min(y + 2, height); ++ny)
            for (std::size_t nx = x - std::min<std::size_t>(x, 1); nx < std::min(x + 2, width);
                 ++nx)
                largest = std::max(largest, error[ny * width + nx]);
        return static_cast<double>(largest);
    }

    /// Makes what a half has of a pixel final. The second half to be settled ends the pixel.
    void settle(Half& half, std::size_t pixel) {
        half.settled[pixel] = 1;
        FilmPixel& result = result_.pixels()[pixel];
        result = mean_of_halves(result, half.film.pixels()[pixel]);
        if (halves_[0].settled[pixel] != 0 && halves_[1].settled[pixel] != 0)
            active_.remove(pixel);
    }

    /// The share done: by the samples, the time or the error (which falls with their square root),
    /// whichever is ahead.
    void report(std::uint32_t n, std::uint64_t rays) const {
        if (!options_.progress)
            return;
        const double by_error = error_ > 0 ? options_.stop.target_error / error_ : 0;
        const double done =
            std::max({static_cast<double>(n) / most_, deadline_.share_used(), by_error * by_error});
        options_.progress({std::min(done, 1.0), rays, error_});
    }

    const TileRenderer& tiles_;
    const RenderOptions& options_;
    RenderStats& stats_;
    Crop crop_;
    std::uint32_t most_; ///< samples of a half
    Deadline deadline_;
    Half halves_[2];
    PixelMask active_;
    Film result_;
    double error_ = 0; ///< of the image as last judged; 0: not yet
};

} // namespace

Film render_adaptively(const RenderJob& job, const TileRenderer& tiles,
                       const RenderOptions& options, RenderStats& stats) {
    return AdaptiveRender(job, tiles, options, stats).run();
}

} // namespace plumb
