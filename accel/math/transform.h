/// \file  Affine transforms in double, applied once while loading.
#pragma once

#include "accel/math/vec.h"

#include <array>
#include <optional>

namespace plumb {

/// A 4x4 matrix, row-major, acting on column vectors: world = M * local.
struct Transform {
    std::array<std::array<double, 4>, 4> m{
        {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

    /// Right-hand side first: (a * b)(p) = a(b(p)).
    [[nodiscard]] Transform operator*(const Transform& b) const;
    [[nodiscard]] Vec3 point(Vec3 p) const;
    [[nodiscard]] Vec3 vector(Vec3 v) const;
    /// Unit normal: the inverse transpose applied, then normalized. Where the determinant is
    /// negative a mesh's winding turns over but its normals do not: the caller swaps two vertices.
    [[nodiscard]] Vec3 normal(Vec3 n) const;
    /// Of the upper-left 3x3 part.
    [[nodiscard]] double determinant() const;
    /// Nothing if the matrix is singular (|det| below 1e-12 of the product of its row lengths) or
    /// has non-finite entries.
    [[nodiscard]] std::optional<Transform> inverse() const;

    [[nodiscard]] static Transform translate(double x, double y, double z);
    [[nodiscard]] static Transform scale(double x, double y, double z);
    /// Counter-clockwise about an axis through the origin (any length but zero).
    [[nodiscard]] static Transform rotate(double axis_x, double axis_y, double axis_z,
                                          double angle_deg);
    /// Camera to world: +z looks from origin to target, +y is up, +x points left in the image.
    /// Nothing if origin = target or the angle between view and up has a sine below 1e-4.
    [[nodiscard]] static std::optional<Transform> look_at(Vec3 origin, Vec3 target, Vec3 up);
};

} // namespace plumb
