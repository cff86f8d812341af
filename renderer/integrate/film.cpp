#include "renderer/integrate/film.h"

namespace plumb {

Film::Film(int full_width, int full_height, const Crop& crop, bool with_variance)
    : full_width_(full_width), full_height_(full_height), crop_(crop),
      with_variance_(with_variance),
      pixels_(static_cast<std::size_t>(crop.width) * static_cast<std::size_t>(crop.height)) {}

FilmPixel& Film::pixel(int x, int y) {
    return pixels_[static_cast<std::size_t>(y - crop_.y) * static_cast<std::size_t>(crop_.width) +
                   static_cast<std::size_t>(x - crop_.x)];
}

Image Film::resolve() const {
    Image image;
    image.width = crop_.width;
    image.height = crop_.height;
    image.full_width = full_width_;
    image.full_height = full_height_;
    image.offset_x = crop_.x;
    image.offset_y = crop_.y;
    image.pixels.reserve(pixels_.size());
    for (const FilmPixel& p : pixels_) {
        const double n = p.count > 0 ? p.count : 1;
        image.pixels.push_back({static_cast<float>(p.sum[0] / n), static_cast<float>(p.sum[1] / n),
                                static_cast<float>(p.sum[2] / n)});
        if (!with_variance_)
            continue;
        const double m = p.count > 1 ? p.count - 1 : 1;
        image.variance.push_back({static_cast<float>(p.m2[0] / m), static_cast<float>(p.m2[1] / m),
                                  static_cast<float>(p.m2[2] / m)});
    }
    return image;
}

} // namespace plumb
