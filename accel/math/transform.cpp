#include "accel/math/transform.h"

#include <cmath>

namespace plumb {
namespace {

struct Double3 {
    double x, y, z;
};

Double3 widen(Vec3 v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
Vec3 narrow(Double3 v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
Double3 cross(Double3 a, Double3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double length(Double3 a) { return std::hypot(a.x, a.y, a.z); }
Double3 normalize(Double3 a) {
    const double l = length(a);
    return {a.x / l, a.y / l, a.z / l};
}

} // namespace

Transform Transform::operator*(const Transform& b) const {
    Transform product;
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 4; ++column) {
            double sum = 0;
            for (std::size_t k = 0; k < 4; ++k)
                sum += m[row][k] * b.m[k][column];
            product.m[row][column] = sum;
        }
    return product;
}

Vec3 Transform::point(Vec3 p) const {
    const Double3 q = widen(p);
    const auto row = [&](std::size_t i) {
        return m[i][0] * q.x + m[i][1] * q.y + m[i][2] * q.z + m[i][3];
    };
    const double w = row(3);
    return narrow({row(0) / w, row(1) / w, row(2) / w});
}

Vec3 Transform::vector(Vec3 v) const {
    const Double3 q = widen(v);
    const auto row = [&](std::size_t i) { return m[i][0] * q.x + m[i][1] * q.y + m[i][2] * q.z; };
    return narrow({row(0), row(1), row(2)});
}

Vec3 Transform::normal(Vec3 n) const {
    // The cofactor matrix is det * inverse transpose; the sign of det is put back.
    const Double3 r0{m[0][0], m[0][1], m[0][2]}, r1{m[1][0], m[1][1], m[1][2]},
        r2{m[2][0], m[2][1], m[2][2]};
    const Double3 c0 = cross(r1, r2), c1 = cross(r2, r0), c2 = cross(r0, r1);
    const Double3 q = widen(n);
    const double sign = determinant() < 0 ? -1 : 1;
    return narrow(normalize(Double3{sign * (c0.x * q.x + c0.y * q.y + c0.z * q.z),
                                    sign * (c1.x * q.x + c1.y * q.y + c1.z * q.z),
                                    sign * (c2.x * q.x + c2.y * q.y + c2.z * q.z)}));
}

double Transform::determinant() const {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

std::optional<Transform> Transform::inverse() const {
    double product = 1;
    for (std::size_t row = 0; row < 3; ++row)
        product *= std::hypot(m[row][0], m[row][1], m[row][2]);
    const double det = determinant();
    const bool affine = m[3][0] == 0 && m[3][1] == 0 && m[3][2] == 0 && m[3][3] == 1;
    if (!affine || !(std::fabs(det) > 1e-12 * product) || !std::isfinite(det))
        return std::nullopt;
    Transform inv;
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t r1 = (c + 1) % 3, r2 = (c + 2) % 3;
            const std::size_t c1 = (r + 1) % 3, c2 = (r + 2) % 3;
            inv.m[r][c] = (m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]) / det;
        }
    for (std::size_t r = 0; r < 3; ++r) {
        inv.m[r][3] = -(inv.m[r][0] * m[0][3] + inv.m[r][1] * m[1][3] + inv.m[r][2] * m[2][3]);
        if (!std::isfinite(inv.m[r][3]))
            return std::nullopt;
    }
    return inv;
}

Transform Transform::translate(double x, double y, double z) {
    Transform t;
    t.m[0][3] = x;
    t.m[1][3] = y;
    t.m[2][3] = z;
    return t;
}

Transform Transform::scale(double x, double y, double z) {
    Transform t;
    t.m[0][0] = x;
    t.m[1][1] = y;
    t.m[2][2] = z;
    return t;
}

Transform Transform::rotate(double axis_x, double axis_y, double axis_z, double angle_deg) {
    const Double3 a = normalize(Double3{axis_x, axis_y, axis_z});
    const double radians = angle_deg * 3.14159265358979323846 / 180;
    const double s = std::sin(radians), c = std::cos(radians), k = 1 - c;
    Transform t;
    t.m[0] = {a.x * a.x * k + c, a.x * a.y * k - a.z * s, a.x * a.z * k + a.y * s, 0};
    t.m[1] = {a.y * a.x * k + a.z * s, a.y * a.y * k + c, a.y * a.z * k - a.x * s, 0};
    t.m[2] = {a.z * a.x * k - a.y * s, a.z * a.y * k + a.x * s, a.z * a.z * k + c, 0};
    return t;
}

std::optional<Transform> Transform::look_at(Vec3 origin, Vec3 target, Vec3 up) {
    const Double3 o = widen(origin), g = widen(target);
    const Double3 view{g.x - o.x, g.y - o.y, g.z - o.z};
    if (!(length(view) > 0) || !(length(widen(up)) > 0))
        return std::nullopt;
    const Double3 forward = normalize(view);
    const Double3 left = cross(normalize(widen(up)), forward);
    if (!(length(left) >= 1e-4))
        return std::nullopt;
    const Double3 x = normalize(left), y = cross(forward, x);
    Transform t;
    t.m[0] = {x.x, y.x, forward.x, o.x};
    t.m[1] = {x.y, y.y, forward.y, o.y};
    t.m[2] = {x.z, y.z, forward.z, o.z};
    return t;
}

} // namespace plumb
