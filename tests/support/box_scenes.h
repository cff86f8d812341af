/// \file  Boxes in the manner of the Cornell box: scenes without a closed form.
#pragma once

#include <string>

namespace plumb::test {

/// Rectangles and a block under one rectangular lamp: what the leanest kernel renders. Parameters
/// $side, $spp, $seed as in scene_text, $sampler (default independent).
[[nodiscard]] std::string plain_box();

/// The same with a ball, a lamp of triangles, a point light and a dim sky through the open front:
/// what only the general kernel renders.
[[nodiscard]] std::string rich_box();

/// plain_box in dialect 0.6: camelCase names, lookAt, toWorld.
[[nodiscard]] std::string plain_box_in_dialect_06();

} // namespace plumb::test
