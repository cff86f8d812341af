/// \file  A hit while it is looked for in the 8-wide tree: a number in place of the two ids.
#pragma once

#include "accel/sah/wide_bvh.h"

namespace plumb {

struct NumberedHit {
    float t, u = 0, v = 0;
    PrimitiveNumber number = invalid_id;

    explicit NumberedHit(float tmax) : t(tmax) {}
    NumberedHit(float t_, float u_, float v_, PrimitiveNumber number_)
        : t(t_), u(u_), v(v_), number(number_) {}

    /// Of two hits at the same t the lower number stays.
    void keep_closer(const PrimitiveHit& hit, PrimitiveNumber candidate) {
        if (hit.t < t || (hit.t == t && candidate < number)) {
            t = hit.t;
            u = hit.u;
            v = hit.v;
            number = candidate;
        }
    }

    /// The hit with its ids; a miss where none was kept.
    [[nodiscard]] Hit with_ids(const WideView& tree) const {
        if (number == invalid_id)
            return {};
        // The last geometry whose first number is not greater: of many the range is halved until
        // eight are left, which are counted without a jump.
        std::uint32_t low = 0, count = tree.geometry_count;
        if (count <= 2) { // a mesh, and spheres or none: not worth eight
            const std::uint32_t second = tree.first_of[1] <= number ? 1u : 0u;
            return {t, u, v, second, number - tree.first_of[second], invalid_id};
        }
        while (count > 8) {
            const std::uint32_t half = count / 2;
            if (tree.first_of[low + half] <= number) {
                low += half;
                count -= half;
            } else {
                count = half;
            }
        }
        std::uint32_t geometry = low - 1;
        for (std::uint32_t i = 0; i < 8; ++i)
            geometry += tree.first_of[low + i] <= number ? 1u : 0u;
        return {t, u, v, geometry, number - tree.first_of[geometry], invalid_id};
    }
};

} // namespace plumb
