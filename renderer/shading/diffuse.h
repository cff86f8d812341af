/// \file  Lambertian reflection, host and device.
#pragma once

#include "renderer/sampling/warp.h"
#include "renderer/scene/scene.h"

namespace plumb {

/// A direction chosen by a BSDF, in the shading frame, on the side of the normal.
struct BsdfSample {
    Vec3 wi;    ///< local, unit, away from the surface
    Rgb weight; ///< f cos(theta) / pdf
    float pdf;  ///< per solid angle; 0: no direction
};

/// f(wo, wi) cos(theta_i) for wo and wi above the surface (z > 0, local).
RT_HD inline Rgb diffuse_times_cos(const Material& m, Vec3 wi) {
    return m.reflectance * (wi.z > 0 ? wi.z * inv_pi : 0.0f);
}

RT_HD inline float diffuse_pdf(Vec3 wi, HemisphereSampling hemisphere) {
    return hemisphere == HemisphereSampling::cosine ? cosine_hemisphere_pdf(wi.z)
                                                    : uniform_hemisphere_pdf(wi.z);
}

RT_HD inline BsdfSample sample_diffuse(const Material& m, Vec2 u, HemisphereSampling hemisphere) {
    if (hemisphere == HemisphereSampling::cosine) {
        const DirectionSample s = sample_cosine_hemisphere(u);
        return {s.direction, m.reflectance, s.pdf};
    }
    const DirectionSample s = sample_uniform_hemisphere(u);
    return {s.direction, m.reflectance * (2 * s.direction.z), s.pdf};
}

} // namespace plumb
