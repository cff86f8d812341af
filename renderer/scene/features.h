/// \file  What a scene contains, and the kernel profiles that serve it.
#pragma once

#include "renderer/scene/scene.h"

#include <string_view>

namespace plumb {

/// What a kernel must be able to do. A structural type: kernels are instantiated by it.
struct Features {
    bool spheres = false; ///< as geometry or as lights
    bool smooth_normals = false;
    bool many_lights = false;     ///< more than one to choose from
    bool triangle_lights = false; ///< rectangles are always there
    bool point_lights = false;
    bool environment = false;

    /// Whether a kernel with these features renders a scene that needs `needed`.
    [[nodiscard]] constexpr bool covers(const Features& needed) const {
        return (spheres || !needed.spheres) && (smooth_normals || !needed.smooth_normals) &&
               (many_lights || !needed.many_lights) &&
               (triangle_lights || !needed.triangle_lights) &&
               (point_lights || !needed.point_lights) && (environment || !needed.environment);
    }
    constexpr bool operator==(const Features&) const = default;
};

/// Profiles, cheapest first; the first that covers a scene runs.
inline constexpr Features box_profile{};
inline constexpr Features full_profile{true, true, true, true, true, true};

[[nodiscard]] Features features_of(const Scene& scene);

/// Name of the profile that serves `needed`, as --explain prints it.
[[nodiscard]] std::string_view profile_name(const Features& needed);

} // namespace plumb
