/// \file  Orders references in place so that one side of a split comes first.
///
/// The i-th reference that stands on the left and belongs to the right changes places with the i-th
/// that stands on the right and belongs to the left. That can be done by one thread or by many, and
/// gives the same order. Where they are is written down without a branch on the outcome: it cannot
/// be guessed (S. Edelkamp, A. Weiss, "BlockQuicksort", ESA 2016).
#pragma once

#include "accel/sah/primitive_ref.h"

#include <algorithm>
#include <utility>

namespace plumb {
namespace detail {

/// The references on one side of the middle, and those of them that belong to the other.
template <class GoesLeft> class Zone {
  public:
    Zone(std::span<PrimitiveRef> refs, bool is_left, const GoesLeft& goes_left)
        : refs_(refs), belongs_(is_left ? 1 : 0), goes_left_(goes_left) {}

    /// Appends the strangers among refs[begin, end) to a list; returns how many.
    std::uint32_t collect(std::size_t begin, std::size_t end, std::uint32_t* strangers) {
        std::uint32_t count = 0;
        Box left = left_, right = right_; // in registers
        for (std::size_t i = begin; i < end; ++i) {
            const Float4 c = centroid(refs_[i].box());
            const unsigned goes_left = goes_left_(refs_[i], c);
            left.extend_point(float4::only_if(goes_left, c));
            right.extend_point(float4::only_if(1 - goes_left, c));
            strangers[count] = static_cast<std::uint32_t>(i);
            count += goes_left ^ belongs_;
        }
        left_ = left;
        right_ = right;
        return count;
    }
    /// Reads on until there is a stranger, or all has been read; how many are waiting.
    std::uint32_t refill() {
        while (taken_ == count_ && next_ < refs_.size()) {
            const std::size_t begin = next_;
            next_ = std::min(next_ + block_size, refs_.size());
            count_ = collect(begin, next_, strangers_);
            taken_ = 0;
        }
        return count_ - taken_;
    }
    PrimitiveRef& take() { return refs_[strangers_[taken_++]]; }

    void merge_centroids(Box& left, Box& right) const {
        left.extend(left_);
        right.extend(right_);
    }

  private:
    static constexpr std::size_t block_size = 128;

    std::span<PrimitiveRef> refs_;
    unsigned belongs_;
    const GoesLeft& goes_left_;
    Box left_, right_; ///< of the centroids that go there
    std::size_t next_ = 0;
    std::uint32_t taken_ = 0, count_ = 0;
    std::uint32_t strangers_[block_size];
};

/// One zone read in chunks by many threads.
template <class GoesLeft> class ChunkedZone {
  public:
    static constexpr std::size_t chunk_size = 1 << 15;

    ChunkedZone(std::span<PrimitiveRef> refs, bool is_left, const GoesLeft& goes_left)
        : refs_(refs), is_left_(is_left), goes_left_(goes_left),
          strangers_(std::make_unique_for_overwrite<std::uint32_t[]>(refs.size())),
          chunks_((refs.size() + chunk_size - 1) / chunk_size) {}

    [[nodiscard]] std::size_t chunk_count() const { return chunks_.size(); }
    void read(std::size_t chunk) {
        const std::size_t begin = chunk * chunk_size;
        Chunk& c = chunks_[chunk];
        Zone<GoesLeft> zone(refs_, is_left_, goes_left_);
        c.count =
            zone.collect(begin, std::min(begin + chunk_size, refs_.size()), &strangers_[begin]);
        zone.merge_centroids(c.left, c.right);
    }
    /// After all chunks are read.
    void finish(Box& left, Box& right) {
        std::size_t sum = 0;
        for (Chunk& c : chunks_) {
            left.extend(c.left);
            right.extend(c.right);
            c.first = sum;
            sum += c.count;
        }
    }
    /// The strangers of a chunk change places with as many of the other zone.
    void swap_with(std::size_t chunk, ChunkedZone& other) {
        const Chunk& c = chunks_[chunk];
        std::size_t their_chunk = 0;
        while (their_chunk + 1 < other.chunks_.size() &&
               other.chunks_[their_chunk + 1].first <= c.first)
            ++their_chunk;
        for (std::size_t i = 0; i < c.count; ++i) {
            while (c.first + i - other.chunks_[their_chunk].first >=
                   other.chunks_[their_chunk].count)
                ++their_chunk;
            const std::size_t theirs = c.first + i - other.chunks_[their_chunk].first;
            std::swap(stranger(chunk, i), other.stranger(their_chunk, theirs));
        }
    }

  private:
    struct Chunk {
        std::uint32_t count = 0;
        std::size_t first = 0;
        Box left, right;
    };

    PrimitiveRef& stranger(std::size_t chunk, std::size_t i) {
        return refs_[strangers_[chunk * chunk_size + i]];
    }

    std::span<PrimitiveRef> refs_;
    bool is_left_;
    const GoesLeft& goes_left_;
    std::unique_ptr<std::uint32_t[]> strangers_; ///< each chunk's at the chunk's place
    std::vector<Chunk> chunks_;
};

} // namespace detail

/// Orders `refs` so that those for which goes_left(ref, centroid) is 1 (else it is 0) come first;
/// there are `left_count` of them. Sets refs and centroids of both sides, not their bounds.
template <class GoesLeft>
void partition(std::span<PrimitiveRef> refs, std::size_t left_count, const GoesLeft& goes_left,
               PrimitiveRange& left, PrimitiveRange& right, const Workers& workers) {
    left.refs = refs.first(left_count);
    right.refs = refs.subspan(left_count);
    left.centroids = right.centroids = {};
    if (workers.count() == 1 || refs.size() < 4 * detail::ChunkedZone<GoesLeft>::chunk_size) {
        detail::Zone<GoesLeft> l(left.refs, true, goes_left), r(right.refs, false, goes_left);
        for (;;) {
            const std::uint32_t count = std::min(l.refill(), r.refill());
            if (count == 0)
                break;
            for (std::uint32_t i = 0; i < count; ++i)
                std::swap(l.take(), r.take());
        }
        l.merge_centroids(left.centroids, right.centroids);
        r.merge_centroids(left.centroids, right.centroids);
        return;
    }
    using Zone = detail::ChunkedZone<GoesLeft>;
    Zone l(left.refs, true, goes_left), r(right.refs, false, goes_left);
    workers.for_each(l.chunk_count() + r.chunk_count(), [&](std::size_t i) {
        i < l.chunk_count() ? l.read(i) : r.read(i - l.chunk_count());
    });
    l.finish(left.centroids, right.centroids);
    r.finish(left.centroids, right.centroids);
    workers.for_each(l.chunk_count(), [&](std::size_t chunk) { l.swap_with(chunk, r); });
}

} // namespace plumb
