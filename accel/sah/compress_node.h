/// \file  Which child goes to which slot of a compressed node, and its boxes in 8 bits.
#pragma once

#include "accel/sah/compressed_view.h"

#include <array>

namespace plumb {

/// Slots for children so that visiting slots in the order of their bits meets near children first:
/// the assignment with the least sum of dot(centre, direction of the slot), of all there are.
/// `boxes`: at most eight. [i]: the slot of child i.
[[nodiscard]] std::array<std::uint32_t, compressed_width>
assign_slots(std::span<const Bounds> boxes);

/// Sets origin, steps and the boxes of the slots that are used; the other slots get boxes that
/// nothing enters. `whole` contains the boxes of all slots. Decoded boxes contain the given ones,
/// with exact arithmetic as well as rounded.
void quantize(const Bounds& whole, std::span<const Bounds, compressed_width> slot_boxes,
              std::uint32_t used_slots, CompressedNode& node);

} // namespace plumb
