/// \file  A cache of lines of four sectors, as a multiprocessor has one.
#pragma once

#include <cstdint>
#include <vector>

namespace plumb::warps {

/// 16 lines a set, the least recently used one goes; a miss fetches the sector alone.
class L1Cache {
  public:
    static constexpr std::uint64_t sector_size = 32, line_size = 128;

    explicit L1Cache(std::uint32_t bytes) : lines_(bytes / line_size) {}

    [[nodiscard]] static std::uint64_t line_of(std::uint64_t sector) {
        return sector / (line_size / sector_size);
    }

    /// Whether the sector was there; it is now. `sector`: address / sector_size.
    bool touch(std::uint64_t sector) {
        const std::uint64_t line = line_of(sector) + 1; // 0: nothing yet
        const auto bit = static_cast<std::uint8_t>(1u << (sector % 4));
        Line* const set = &lines_[line % (lines_.size() / ways) * ways];
        Line* victim = set;
        ++now_;
        for (Line* l = set; l < set + ways; ++l) {
            if (l->tag == line) {
                const bool hit = (l->sectors & bit) != 0;
                l->sectors |= bit;
                l->used = now_;
                return hit;
            }
            if (l->used < victim->used)
                victim = l;
        }
        *victim = {line, now_, bit};
        return false;
    }

  private:
    static constexpr std::size_t ways = 16;

    struct Line {
        std::uint64_t tag = 0, used = 0;
        std::uint8_t sectors = 0;
    };
    std::vector<Line> lines_;
    std::uint64_t now_ = 0;
};

} // namespace plumb::warps
