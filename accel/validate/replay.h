/// \file  Replay files: rays about which two intersectors disagree, with the geometry concerned.
///
/// Text, one record a line, fields apart by single spaces or more; `#` begins a comment line.
/// Floats are hexadecimal (1.8p+1, -0p+0, inf, nan), so that reading gives the bits that were
/// written; the payload of a NaN is not kept. Records in this order:
///
///     plumbline-replay 1                        version, the first line
///     scene FILE                                where the rays come from; for people
///     test watertight|moeller-trumbore          of naive and sah
///     pair FIRST SECOND                         the two that were compared: naive, sah or embree
///     geometry whole|concerned                  all primitives, or those that the rays concern
///     triangle GEOMETRY PRIMITIVE 9 FLOATS      ids as in the scene, three corners
///     sphere GEOMETRY PRIMITIVE 4 FLOATS        centre and radius
///     ray KIND AGREEMENT CULPRIT 8 FLOATS       origin, tmin, direction, tmax; then two lines:
///     first ANSWER                              miss, or: hit GEOMETRY PRIMITIVE T U V; for shadow
///     second ANSWER                             rays after one word: blocked or free
///     end
///
/// KIND, AGREEMENT and CULPRIT are the names of RayKind, Agreement and Culprit. What occluded()
/// said is `blocked` or `free`; the hit after it is what closest() says of the same ray. Triangles
/// and spheres ascend by (geometry, primitive).
#pragma once

#include "accel/validate/validating_intersector.h"

#include <stdexcept>
#include <string>

namespace plumb {

/// A primitive with its ids in the scene. Of a sphere: a is the centre, radius > 0 or not.
struct ReplayPrimitive {
    std::uint32_t geometry = 0, primitive = 0;
    bool is_sphere = false;
    TriangleVertices triangle{};
    Sphere sphere{};
};

struct Replay {
    std::string scene;
    TriangleTest triangle_test = TriangleTest::watertight;
    AccelKind first = AccelKind::sah, second = AccelKind::embree;
    bool whole_geometry = false;
    std::vector<ReplayPrimitive> primitives; ///< ascending by (geometry, primitive)
    std::vector<Disagreement> rays;
};

/// A replay file that cannot be read: "line 12: what (got 'x', expected y)".
class ReplayError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The rays with the primitives that they concern: those hit by either side and their neighbours
/// at shared corners; all primitives where the scene has few (at most 10000).
[[nodiscard]] Replay make_replay(const GeometryView& geometry, std::vector<Disagreement> rays);

[[nodiscard]] std::string to_text(const Replay& replay);
/// Throws ReplayError.
[[nodiscard]] Replay parse_replay(std::string_view text);

} // namespace plumb
