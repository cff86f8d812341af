#include "tools/stability_src/axis.h"

#include <cmath>

namespace plumb::stability {

double Axis::badness(const Outcome& outcome) const {
    if (!counts())
        return outcome.value && std::isfinite(*outcome.value)
                   ? *outcome.value
                   : std::numeric_limits<double>::infinity();
    return outcome.trials > 0
               ? static_cast<double>(outcome.failures) / static_cast<double>(outcome.trials)
               : std::numeric_limits<double>::infinity();
}

bool Axis::violated(std::size_t method, double stress, const Outcome& outcome) const {
    const Method& m = methods[method];
    return m.judged_at(stress) && badness(outcome) > *m.limit;
}

std::vector<Axis> all_axes() {
    std::vector<Axis> axes;
    add_triangle_axes(axes);
    add_slab_axes(axes);
    add_sphere_axes(axes);
    add_ray_offset_axes(axes);
    add_light_axes(axes);
    add_roulette_axis(axes);
    add_direction_axes(axes);
    add_sum_axes(axes);
    add_tree_axes(axes);
    return axes;
}

} // namespace plumb::stability
