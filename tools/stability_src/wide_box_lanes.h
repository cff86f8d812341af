/// \file  NodeTest of accel/sah/isa for one box. Include a file of lanes before it.
#pragma once

#include "accel/intersector.h"
#include "accel/sah/isa/wide_traverse.h"

#include <algorithm>

namespace plumb::stability {
namespace {

/// The box in all lanes of a node: all must agree.
inline bool enters_all_lanes(const Ray& ray, const Bounds& box) {
    float reach = 0;
    WideNode node;
    for (int axis = 0; axis < 3; ++axis) {
        reach = max(reach, max(std::fabs(box.lower[axis]), std::fabs(box.upper[axis])));
        std::fill_n(node.planes[axis][0], wide_width, box.lower[axis]);
        std::fill_n(node.planes[axis][1], wide_width, box.upper[axis]);
    }
    const NodeTest<Lanes> test{WideRay(ray, reach)};
    Lanes::Floats near;
    return test(node, Lanes::broadcast(ray.tmax), near) == 0xff;
}

} // namespace
} // namespace plumb::stability
