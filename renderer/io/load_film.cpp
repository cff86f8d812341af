/// \file  Reading of films and reconstruction filters.
#include "renderer/io/load_film.h"

#include "renderer/io/load_properties.h"

#include <fmt/format.h>

namespace plumb {
namespace {

void load_crop(Properties& p, FilmSettings& film) {
    Crop& crop = film.crop;
    crop.x = static_cast<int>(p.integer("crop_offset_x", 0, 0, film.width - 1));
    crop.y = static_cast<int>(p.integer("crop_offset_y", 0, 0, film.height - 1));
    const int room_x = film.width - crop.x, room_y = film.height - crop.y;
    crop.width = static_cast<int>(p.integer("crop_width", room_x, 1, room_x));
    crop.height = static_cast<int>(p.integer("crop_height", room_y, 1, room_y));
}

Filter load_filter(LoadContext& context, const XmlNode& node) {
    const std::string_view plugin =
        context.plugin(node, {"box", "tent", "gaussian", "mitchell"}, "taken as gaussian");
    Properties p(context, node);
    Filter filter;
    if (plugin == "box") {
        filter.kind = FilterKind::box;
        p.not_supported({"radius"});
    } else if (plugin == "tent") {
        filter.kind = FilterKind::tent;
        filter.radius = static_cast<float>(p.positive("radius", 1));
    } else if (plugin == "mitchell") {
        filter.kind = FilterKind::mitchell;
        filter.b = static_cast<float>(p.number("b", 1.0 / 3));
        filter.c = static_cast<float>(p.number("c", 1.0 / 3));
    } else {
        filter.stddev = static_cast<float>(p.positive("stddev", 0.5));
    }
    if (plugin.empty())
        p.ignore_rest();
    p.finish();
    return filter;
}

} // namespace

void load_film(LoadContext& context, const XmlNode& node) {
    const std::string_view plugin =
        context.plugin(node, {"hdrfilm", "ldrfilm"}, "taken as hdrfilm");
    Properties p(context, node);
    FilmSettings& film = context.scene.film;
    film.width = static_cast<int>(p.integer("width", 768, 1, max_film_side));
    film.height = static_cast<int>(p.integer("height", 576, 1, max_film_side));
    load_crop(p, film);
    const std::vector<const XmlNode*> filters = p.objects("rfilter");
    if (filters.size() > 1)
        filters[1]->refuse("second <rfilter> in one film (expected one)");
    if (!filters.empty())
        film.filter = load_filter(context, *filters.front());
    // File formats and display: the command line decides those. The film's values stay linear.
    p.changes_no_pixel({"banner", "file_format", "pixel_format", "component_format", "gamma",
                        "exposure", "tonemap_method", "key", "burn", "label", "attach_log",
                        "high_quality_edges", "sample_border", "compensate", "fast"});
    if (plugin.empty())
        p.ignore_rest();
    p.finish();
}

} // namespace plumb
