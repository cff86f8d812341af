/// \file  The referee: one ray against one primitive in double, and how far a float test may err.
///
/// Its own errors are 2^-29 times those that it grants to others: double against float on the same
/// conditioning.
#pragma once

#include "accel/geometry.h"

#include <limits>

namespace plumb {

/// What a correct float test may say: `either` where rounding decides.
enum class Answer : std::uint8_t { no, yes, either };

/// A crossing of the ray's line with a primitive's surface.
struct Crossing {
    double t = std::numeric_limits<double>::quiet_NaN();
    double t_error = 0;           ///< bound for float tests, in t
    Answer in_range = Answer::no; ///< tmin < t <= tmax
};

/// The referee's opinion of one ray and one primitive.
struct Judgement {
    Answer answer = Answer::no; ///< whether there is a hit: inside the outline and in range
    Answer inside = Answer::no; ///< whether the line meets the primitive, whatever the range
    /// Distance from the outline in units of the bound: above 1 certainly inside, below -1
    /// certainly outside.
    double margin = -std::numeric_limits<double>::infinity();
    Crossing near, far;                ///< far: of spheres; of triangles equal to near
    double u = 0, v = 0, uv_error = 0; ///< barycentrics and their bound; triangles only
};

/// Judges one primitive. Ids out of range, primitives that are not traceable and invalid rays give
/// `no`.
///
/// Bounds, with u = 2^-24 and R the distance from the origin to the farthest vertex:
/// - Edges. The shear of the watertight test rounds a vertex's place beside the ray five times,
///   which 8 u R bounds. An edge function of two vertices at p and q beside the ray is then wrong
///   by 8 u R (|p| + |q|) + 2 u |p| |q|. Plücker tests (Embree's robust mode) form the product of
///   the edge e with the sum of its ends instead: 8 u |e| R more. A hit is certain where all three
///   functions have one sign beyond these bounds and impossible where two have opposite ones.
/// - t. Edge functions are weights of the vertices' depths, so their errors times the difference in
///   depth, divided by the projected area; tests that divide by the normal n (Embree) err by
///   8 u (|n| R + |e1| |e2| |e|) over that area: both grow by 1 / cosine at grazing hits. Never
///   less than 4 u of the farthest depth, for the slab interval into which hits are moved, and than
///   a few of float's smallest numbers, where rounding is not relative.
/// - u and v: the edge functions' errors over the area, and 4 u.
/// - Spheres. All tests here are in double, so t is wrong by the float slab interval into which it
///   is moved, 8 u of the distance over the speed, and by the square root at the silhouette. The
///   outline is known to 8 u (distance + radius), again for the slab test.
/// - Where the products of a float test leave float's range, every `yes` or `no` about the inside
///   that is not plain becomes `either`.
[[nodiscard]] Judgement judge(const GeometryView& view, std::uint32_t geometry,
                              std::uint32_t primitive, const Ray& ray);

/// Whether a reported t is right: at a crossing that can be in range, within its bound or 8 ulp. Of
/// two crossings the far one counts only where the near one is not certainly in range.
[[nodiscard]] bool is_right_t(const Judgement& judgement, float t);

/// Whether reported barycentrics are right: within the bound or 8 ulp of 1. On spheres: 0.
[[nodiscard]] bool are_right_uv(const Judgement& judgement, float u, float v);

/// |t - the referee's| in units of the bound that is_right_t grants; 0 where the bound is infinite.
[[nodiscard]] double share_of_bound(const Judgement& judgement, float t);

/// Corners of two triangles at the same place, 0 to 3 for triangles without double corners; 0 where
/// one is a sphere.
[[nodiscard]] int shared_corners(const GeometryView& view, const Hit& a, const Hit& b);

/// Whether the surface goes on around the ray: the ray passes an edge or a corner of `hit` within
/// rounding, and triangles that share a corner with it, at the same depth and certainly in range,
/// cover a small circle around the ray. A watertight method hits one of them. Scans all triangles.
[[nodiscard]] bool is_closed_around(const GeometryView& view, const Hit& hit, const Ray& ray);

/// A primitive that the ray certainly hits; else one that it may hit; else an invalid hit. Judges
/// all primitives.
[[nodiscard]] Hit search(const GeometryView& view, const Ray& ray);

} // namespace plumb
