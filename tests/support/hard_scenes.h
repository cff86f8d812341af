/// \file  Scenes on which builders of trees fail.
#pragma once

#include "tests/support/meshes.h"

namespace plumb::test {

struct NamedScene {
    const char* name;
    TestGeometry geometry;
};

/// Equal centroids, boxes at 2^i, boxes in boxes, flat, huge, tiny, not traceable, empty.
[[nodiscard]] std::vector<NamedScene> hard_scenes();

} // namespace plumb::test
