/// \file  The one switch over kinds of materials, host and device.
///
/// Directions are local (z the shading normal, turned to the side of wo); wo and wi point away from
/// the surface.
#pragma once

#include "renderer/shading/diffuse.h"

namespace plumb {

/// f(wo, wi) |cos(theta_i)|, reciprocal but for the cosine.
RT_HD inline Rgb bsdf_times_cos(const Material& m, Vec3 /*wo*/, Vec3 wi) {
    switch (m.kind) {
    case MaterialKind::diffuse: return diffuse_times_cos(m, wi);
    }
    return {};
}

/// Pdf per solid angle of sample_bsdf.
RT_HD inline float bsdf_pdf(const Material& m, Vec3 /*wo*/, Vec3 wi,
                            HemisphereSampling hemisphere) {
    switch (m.kind) {
    case MaterialKind::diffuse: return diffuse_pdf(wi, hemisphere);
    }
    return 0;
}

/// A direction drawn from the BSDF, u uniform in [0,1)^2. Empty (pdf 0) where nothing reflects.
RT_HD inline BsdfSample sample_bsdf(const Material& m, Vec3 /*wo*/, Vec2 u,
                                    HemisphereSampling hemisphere) {
    switch (m.kind) {
    case MaterialKind::diffuse: return sample_diffuse(m, u, hemisphere);
    }
    return {{}, {}, 0};
}

} // namespace plumb
