#include "accel/sah/compress_node.h"

#include <bit>
#include <cmath>

namespace plumb {
namespace {

/// Grid of one axis.
struct Grid {
    float origin;
    std::uint32_t exponent; ///< biased

    [[nodiscard]] float step() const { return std::bit_cast<float>(exponent << 23); }
    [[nodiscard]] float plane(int q) const { return origin + static_cast<float>(q) * step(); }
    [[nodiscard]] double distance(float plane) const {
        return static_cast<double>(plane) - static_cast<double>(origin);
    }
    [[nodiscard]] double distance(int q) const {
        return static_cast<double>(q) * static_cast<double>(step()); // exact
    }
    [[nodiscard]] bool is_below(int q, float lower) const {
        return distance(q) <= distance(lower) && plane(q) <= lower;
    }
    [[nodiscard]] bool is_above(int q, float upper) const {
        return distance(q) >= distance(upper) && plane(q) >= upper;
    }
    [[nodiscard]] int below(float lower) const {
        int q = static_cast<int>(std::floor(distance(lower) / static_cast<double>(step())));
        while (!is_below(q, lower))
            --q; // 0 is the origin, which is below
        return q;
    }
    [[nodiscard]] int above(float upper) const {
        int q = static_cast<int>(std::ceil(distance(upper) / static_cast<double>(step())));
        while (!is_above(q, upper))
            ++q;
        return q;
    }
};

/// The finest grid whose 255 steps span the box.
Grid grid_of(float lower, float upper) {
    Grid grid{lower, 1};
    int exponent = 0;
    std::frexp(grid.distance(upper) / 255, &exponent); // distance <= 255 * 2^exponent
    grid.exponent = static_cast<std::uint32_t>(std::max(exponent - 1 + 127, 1));
    while (!grid.is_above(255, upper))
        ++grid.exponent;
    return grid;
}

void set_byte(std::uint32_t (&words)[2], std::uint32_t slot, int value) {
    words[slot / 4] |= static_cast<std::uint32_t>(value) << (8 * (slot % 4));
}

} // namespace

std::array<std::uint32_t, compressed_width> assign_slots(std::span<const Bounds> boxes) {
    constexpr std::uint32_t subsets = 1u << compressed_width;
    // least[s]: cost of giving the slots of s to as many children, the first ones.
    std::array<double, subsets> least;
    std::array<std::uint8_t, subsets> last; ///< slot of the last of them
    least.fill(std::numeric_limits<double>::infinity());
    least[0] = 0;
    for (std::uint32_t s = 0; s < subsets; ++s) {
        const auto child = static_cast<std::size_t>(std::popcount(s));
        if (child >= boxes.size())
            continue;
        const Vec3 c = boxes[child].center();
        for (std::uint32_t slot = 0; slot < compressed_width; ++slot) {
            if ((s >> slot & 1u) != 0)
                continue;
            double cost = least[s];
            for (std::uint32_t axis = 0; axis < 3; ++axis)
                cost += (slot >> axis & 1u) != 0 ? -static_cast<double>(c[static_cast<int>(axis)])
                                                 : static_cast<double>(c[static_cast<int>(axis)]);
            const std::uint32_t with = s | 1u << slot;
            if (cost < least[with]) {
                least[with] = cost;
                last[with] = static_cast<std::uint8_t>(slot);
            }
        }
    }
    std::uint32_t best = 0;
    double cost = std::numeric_limits<double>::infinity();
    for (std::uint32_t s = 0; s < subsets; ++s)
        if (static_cast<std::size_t>(std::popcount(s)) == boxes.size() && least[s] < cost) {
            best = s;
            cost = least[s];
        }
    std::array<std::uint32_t, compressed_width> slots{};
    for (std::size_t child = boxes.size(); child > 0; --child) {
        slots[child - 1] = last[best];
        best &= ~(1u << last[best]);
    }
    return slots;
}

void quantize(const Bounds& whole, std::span<const Bounds, compressed_width> slot_boxes,
              std::uint32_t used_slots, CompressedNode& node) {
    node.exponents &= 0xff000000u;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<int>(axis);
        const Grid grid = used_slots == 0 ? Grid{0, 127} : grid_of(whole.lower[a], whole.upper[a]);
        node.origin[axis] = grid.origin;
        node.exponents |= grid.exponent << (8 * axis);
        for (std::uint32_t half = 0; half < 2; ++half)
            node.lower[axis][half] = node.upper[axis][half] = 0;
        for (std::uint32_t slot = 0; slot < compressed_width; ++slot) {
            const bool used = (used_slots >> slot & 1u) != 0;
            set_byte(node.lower[axis], slot, used ? grid.below(slot_boxes[slot].lower[a]) : 255);
            set_byte(node.upper[axis], slot, used ? grid.above(slot_boxes[slot].upper[a]) : 0);
        }
    }
}

} // namespace plumb
